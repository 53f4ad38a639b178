#include "preprocess/builder/reuse.h"

#include <fstream>
#include <stdexcept>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "bullet_ambient/fluid_body/fluid_body_file_header.h"

namespace ambient {

std::optional<FluidBody> readIfSame(const std::filesystem::path& file, const std::string& name,
                                    const Provenance& provenance) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  try {
    FluidBody body = readFluidBody(file);
    const Provenance& found = body.provenance;
    const bool is_same = body.name == name && found.source == provenance.source &&
                         found.source_hash == provenance.source_hash &&
                         found.settings == provenance.settings &&
                         found.generator == provenance.generator;
    if (is_same) return body;
  } catch (const std::runtime_error&) {
    // A damaged or foreign file is as good as none.
  }
  return std::nullopt;
}

void requireReplaceable(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return;
  std::string bytes(kFileHeaderSize, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (bytes.empty()) return;
  try {
    static_cast<void>(decodeFileHeader(bytes, file.string()));
  } catch (const std::runtime_error& foreign) {
    throw std::runtime_error(std::string(foreign.what()) + ", and is not replaced");
  }
}

}  // namespace ambient
