#pragma once

#include <string>
#include <vector>

namespace ambient {

/// Finds the word with the fewest insertions, deletions, replacements and swaps of neighbours to
/// become `word`; empty if that number exceeds a third of the letters of `word`, at least two.
std::string closestWord(const std::string& word, const std::vector<std::string>& words);

}  // namespace ambient
