#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "preprocess/mesh/input_error.h"

namespace ambient {

/// A defect that prevents a mesh from representing a body or a sheet.
struct MeshDefect {
  std::string kind;            ///< in a few words: "not watertight"
  std::string text;            ///< how often, and an example, in one line
  std::vector<int> triangles;  ///< all that have it, or those of the example
};

/// @throws std::runtime_error in one line that begins with `name`, with the first defect, if any.
inline void requireNone(const std::vector<MeshDefect>& defects, const std::string& name) {
  if (!defects.empty()) raiseInputError(name, defects.front().text);
}

/// The parts of a sentence with numbers as messages have them.
template <class... Parts>
std::string defectText(const Parts&... parts) {
  std::ostringstream text;
  text.precision(9);
  (text << ... << parts);
  return text.str();
}

}  // namespace ambient
