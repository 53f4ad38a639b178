#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace ambient {

/// "source: parts" in one line.
template <class... Parts>
std::string inputMessage(const std::string& source, const Parts&... parts) {
  std::ostringstream message;
  message.precision(9);
  message << source << ": ";
  (message << ... << parts);
  return message.str();
}

/// Refuses bad input in one line that begins with `source`, the file or shape it came from.
/// @throws std::runtime_error always.
template <class... Parts>
[[noreturn]] void raiseInputError(const std::string& source, const Parts&... parts) {
  throw std::runtime_error(inputMessage(source, parts...));
}

}  // namespace ambient
