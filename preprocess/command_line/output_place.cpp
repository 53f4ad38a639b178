#include "preprocess/command_line/output_place.h"

#include <system_error>

#include "preprocess/builder/output_file.h"
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

}  // namespace ambient
