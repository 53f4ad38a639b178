#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace ambient {

/// A defect that prevents a mesh from representing a body or a sheet.
struct MeshDefect {
  std::string kind;            ///< in a few words: "not watertight"
  std::string text;            ///< number of occurrences and an example, in one line
  std::vector<int> triangles;  ///< all triangles with the defect, or those of the example
};

/// Joins the parts of a sentence; numbers have 9 digits.
template <class... Parts>
std::string defectText(const Parts&... parts) {
  std::ostringstream text;
  text.precision(9);
  (text << ... << parts);
  return text.str();
}

}  // namespace ambient
