#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ambient {

/// Replaces control characters except line ends by "?". Names of files may hold escape sequences,
/// which a terminal would obey.
std::string plainText(const std::string& text);

/// Like plainText(), but in one line: line ends become a backslash and the letter n.
std::string plainLine(const std::string& text);

// Words for enumerators. A table is an array of pairs of an enumerator and its word, such as
// kPressureLawNames.

/// Returns the word for an enumerator; null if the table has none.
template <class Names, class Value>
constexpr const char* wordOf(const Names& names, Value value) {
  for (const auto& [known, word] : names)
    if (known == value) return word;
  return nullptr;
}

/// Returns the enumerator that a word stands for; none if the table has no such word.
template <class Names>
constexpr auto valueOf(const Names& names, std::string_view wanted)
    -> std::optional<typename Names::value_type::first_type> {
  for (const auto& [value, word] : names)
    if (wanted == word) return value;
  return std::nullopt;
}

}  // namespace ambient
