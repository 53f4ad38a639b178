#pragma once

#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/plain_text.h"

namespace ambient {

/// Returns "source: parts" in one line; control characters are shown, see plainLine().
template <class... Parts>
std::string inputMessage(const std::string& source, const Parts&... parts) {
  std::ostringstream message;
  message.precision(9);
  message << source << ": ";
  (message << ... << parts);
  return plainLine(message.str());
}

/// Refuses bad input in one line that begins with `source`, the file or shape it came from.
/// @throws std::runtime_error always.
template <class... Parts>
[[noreturn]] void raiseInputError(const std::string& source, const Parts&... parts) {
  throw std::runtime_error(inputMessage(source, parts...));
}

/// Calls a function whose errors do not tell the file or shape that they come from.
/// @throws std::runtime_error in one line that begins with `source`.
template <class Body>
auto withSource(const std::string& source, const Body& body) {
  try {
    return body();
  } catch (const std::runtime_error& error) {
    raiseInputError(source, error.what());
  }
}

/// Refuses a file that is missing, a folder, a pipe or a device, which may never end. `kind`: kind
/// of file, for the message.
/// @throws std::runtime_error in one line that names the file.
inline void requireRegularFile(const std::filesystem::path& file, const char* kind) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) raiseInputError(file.string(), "no such file");
  if (std::filesystem::is_directory(status))
    raiseInputError(file.string(), "is a directory, not a ", kind, " file");
  if (!std::filesystem::is_regular_file(status))
    raiseInputError(file.string(), "is not a regular file");
}

}  // namespace ambient
