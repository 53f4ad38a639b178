#include "preprocess/command_line/output_place.h"

#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/output_file.h"
#include "preprocess/command_line/input_shape.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {

void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input) {
  std::error_code error;
  const std::filesystem::path target = linkTarget(output);
  const std::filesystem::path folder = target.parent_path().empty() ? "." : target.parent_path();
  if (!std::filesystem::is_directory(folder, error)) {
    raiseInputError(output.string(), "the directory ", folder, " does not exist");
  }
  if (std::filesystem::status(target, error).type() == std::filesystem::file_type::none)
    raiseInputError(output.string(), "cannot be written: ", error.message());
  if (std::filesystem::is_directory(target, error))
    raiseInputError(output.string(), "is a directory");
  if (std::filesystem::equivalent(output, input, error)) {
    raiseInputError(output.string(), "the output would replace the input");
  }
}

void requireReplaceable(const std::filesystem::path& output) {
  std::error_code error;
  if (hasExtension(output, ".ambient") || !std::filesystem::is_regular_file(output, error)) return;
  std::string bytes(kFileHeaderSize, '\0');
  std::ifstream stream(output, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (bytes.empty()) return;
  try {
    static_cast<void>(decodeFileHeader(bytes, output.string()));
  } catch (const std::runtime_error& foreign) {
    throw std::runtime_error(std::string(foreign.what()) + ", and is not replaced");
  }
}

}  // namespace ambient
