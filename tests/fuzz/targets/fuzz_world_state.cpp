#include <memory>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/saved_state.h"
#include "tests/fuzz/targets/fuzz_file.h"
#include "tests/fuzz/targets/seed_bodies.h"

namespace ambient::test {
namespace {

// Magic, version, bytes per number, checksum.
constexpr std::size_t kHeaderSize = 24, kChecksumAt = 16;

std::shared_ptr<const FluidBody> find(const std::string& name) {
  static const auto body = std::make_shared<const FluidBody>(seedFluidBody());
  return name == body->name ? body : nullptr;
}

// Reads; an accepted state must encode to the same bytes.
void readAndWrite(const std::string& bytes) {
  mayRefuse([&] {
    if (encodeState(decodeState(bytes, "fuzz", find)) != bytes) {
      throw std::logic_error("a state changed on its way through bytes");
    }
  });
}

// Corrects the checksum, which nearly every mutation would fail.
void readAsPayload(std::string bytes) {
  if (bytes.size() < kHeaderSize) return;
  const std::uint64_t checksum = fnv1a64(std::string_view(bytes).substr(kHeaderSize));
  for (std::size_t i = 0; i < sizeof checksum; ++i) {
    bytes[kChecksumAt + i] = static_cast<char>(checksum >> (8 * i));
  }
  readAndWrite(bytes);
}

}  // namespace
}  // namespace ambient::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(ambient::test::textOf(data, size));
  ambient::test::readAndWrite(bytes);
  ambient::test::readAsPayload(bytes);
  return 0;
}
