#include "bullet_ambient/bullet/world/ambient_serializer.h"

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "bullet_ambient/bullet/world/fluid.h"

AMBIENT_BEGIN
namespace {

constexpr std::size_t kAlignment = 8;  // of chunks in the file

// Length, state, zeros up to the alignment.
std::string paddedState(const Fluid& fluid) {
  const std::string state = encodeState(fluid.save());
  const auto size = static_cast<std::uint64_t>(state.size());
  std::string bytes(sizeof size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  bytes += state;
  bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
  return bytes;
}

std::string_view stateIn(std::string_view chunk, const std::string& source) {
  std::uint64_t size = 0;
  if (chunk.size() >= sizeof size) {
    std::memcpy(&size, chunk.data(), sizeof size);
    chunk.remove_prefix(sizeof size);
    if (size <= chunk.size()) return chunk.substr(0, size);
  }
  throw std::runtime_error(source + ": the chunk of the saved state is cut short");
}

}  // namespace

void AmbientSerializer::finishSerialization() {
  const std::string bytes = paddedState(fluid_);
  btChunk* chunk = allocate(bytes.size(), 1);
  std::memcpy(chunk->m_oldPtr, bytes.data(), bytes.size());
  // "char" has no number in the file's type table, which makes Bullet's loader pass the chunk by.
  finalizeChunk(chunk, "char", kAmbientChunkCode, this);
  btDefaultSerializer::finishSerialization();
}

WorldState readAmbientChunk(std::string_view file, const std::string& source,
                            const FluidBodyLookup& lookup) {
  const char pointer_size = sizeof(void*) == 8 ? '-' : '_';
  if (file.size() < BT_HEADER_LENGTH || file.substr(0, 6) != "BULLET" || file[7] != pointer_size ||
      file[8] != 'v') {
    throw std::runtime_error(source + ": this is no .bullet file of this kind of machine");
  }
  file.remove_prefix(BT_HEADER_LENGTH);
  while (file.size() >= sizeof(btChunk)) {
    btChunk chunk;
    std::memcpy(&chunk, file.data(), sizeof chunk);
    file.remove_prefix(sizeof chunk);
    if (chunk.m_length < 0 || static_cast<std::size_t>(chunk.m_length) > file.size()) break;
    const auto length = static_cast<std::size_t>(chunk.m_length);
    if (chunk.m_chunkCode == kAmbientChunkCode) {
      return decodeState(stateIn(file.substr(0, length), source), source, lookup);
    }
    file.remove_prefix(length);
  }
  throw std::runtime_error(source + ": there is no saved state of ambient bodies in this file");
}

AMBIENT_END
