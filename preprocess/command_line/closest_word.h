#pragma once

#include <string>
#include <vector>

namespace ambient {

/// The word that takes the fewest insertions, deletions, replacements and swaps of neighbours to
/// become `word`; empty if even that takes more than a third of its letters, at least two.
std::string closestWord(const std::string& word, const std::vector<std::string>& words);

}  // namespace ambient
