#pragma once

#include <string>

namespace ambient {

/// A text in which control characters, but for line ends, have become "?": names of files may hold
/// anything, and a terminal obeys what begins with an escape.
std::string plainText(const std::string& text);

/// The same in one line: line ends become "\n" in letters.
std::string plainLine(const std::string& text);

}  // namespace ambient
