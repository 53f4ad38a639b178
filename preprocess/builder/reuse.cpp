#include "preprocess/builder/reuse.h"

#include <stdexcept>

#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {

std::optional<FluidBody> readIfSame(const std::filesystem::path& file, const std::string& name,
                                    const Provenance& provenance) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  try {
    FluidBody body = readPrepared(file);
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

std::string keptFileName(const std::string& name, const Provenance& provenance) {
  const std::string text = name + '\n' + provenance.source + '\n' +
                           std::to_string(provenance.source_hash) + '\n' + provenance.settings +
                           '\n' + provenance.generator;
  return hashText(fnv1a64(text)) + ".ambient";
}

}  // namespace ambient
