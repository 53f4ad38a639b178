#pragma once

#include <string>

namespace ambient {

/// Replaces control characters except line ends by "?". Names of files may hold escape sequences,
/// which a terminal would obey.
std::string plainText(const std::string& text);

/// Like plainText(), but in one line: line ends become a backslash and the letter n.
std::string plainLine(const std::string& text);

}  // namespace ambient
