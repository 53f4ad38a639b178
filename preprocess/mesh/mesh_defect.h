#pragma once

#include <string>
#include <vector>

namespace ambient {

/// What keeps a mesh from standing for a body or a sheet.
struct MeshDefect {
  std::string kind;            ///< in a few words: "not watertight"
  std::string text;            ///< how often, and an example, in one line
  std::vector<int> triangles;  ///< all that have it, or those of the example
};

}  // namespace ambient
