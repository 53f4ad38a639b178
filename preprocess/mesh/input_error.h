#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace ambient {

/// Refuses bad input in one line that begins with `source`, the file or shape it came from.
/// @throws std::runtime_error always.
template <class... Parts>
[[noreturn]] void raiseInputError(const std::string& source, const Parts&... parts) {
  std::ostringstream message;
  message.precision(9);
  message << source << ": ";
  (message << ... << parts);
  throw std::runtime_error(message.str());
}

}  // namespace ambient
