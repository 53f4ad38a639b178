#pragma once

#include <optional>
#include <string_view>

namespace ambient {

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
