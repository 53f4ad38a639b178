#include "preprocess/command_line/output_place.h"

#include <system_error>

#include "preprocess/mesh/input_error.h"

namespace ambient {

void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input) {
  std::error_code error;
  const std::filesystem::path folder = output.parent_path().empty() ? "." : output.parent_path();
  if (!std::filesystem::is_directory(folder, error)) {
    raiseInputError(output.string(), "the directory ", folder, " does not exist");
  }
  if (std::filesystem::is_directory(output, error))
    raiseInputError(output.string(), "is a directory");
  if (std::filesystem::equivalent(output, input, error)) {
    raiseInputError(output.string(), "the output would replace the input");
  }
}

}  // namespace ambient
