#include "preprocess/command_line/closest_word.h"

#include <algorithm>

namespace ambient {
namespace {

/// Edit distance with swaps of neighbours (optimal string alignment).
std::size_t distanceBetween(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replace = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + replace});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string closestWord(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t kLeast = 2;
  std::string closest;
  std::size_t smallest = std::max(kLeast, word.size() / 3) + 1;
  for (const std::string& candidate : words) {
    const std::size_t distance = distanceBetween(word, candidate);
    if (distance >= smallest) continue;
    smallest = distance;
    closest = candidate;
  }
  return closest;
}

}  // namespace ambient
