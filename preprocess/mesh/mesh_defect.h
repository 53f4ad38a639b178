#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "preprocess/mesh/input_error.h"

namespace ambient {

/// A defect that prevents a mesh from representing a body or a sheet.
struct MeshDefect {
  std::string kind;            ///< in a few words: "not watertight"
  std::string text;            ///< number of occurrences and an example, in one line
  std::vector<int> triangles;  ///< all triangles with the defect, or those of the example
};

/// Refuses a mesh with defects. @throws std::runtime_error in one line that begins with `name`,
/// with the first defect.
inline void requireNone(const std::vector<MeshDefect>& defects, const std::string& name) {
  if (!defects.empty()) raiseInputError(name, defects.front().text);
}

/// Joins the parts of a sentence; numbers have 9 digits.
template <class... Parts>
std::string defectText(const Parts&... parts) {
  std::ostringstream text;
  text.precision(9);
  (text << ... << parts);
  return text.str();
}

}  // namespace ambient
