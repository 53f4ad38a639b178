#pragma once

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"

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

/// Result of a check: a mesh, perhaps with triangles turned round or vertices removed, warnings
/// about such changes, one line each, and what is still wrong with it.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
  /// Closed parts inside the body, normals into the cavity; the fluid outside does not see them.
  TriangleMesh cavities = {};
  std::vector<MeshDefect> defects = {};  ///< empty: the mesh is sound
  bool is_wrapped = false;               ///< true: a closed surface around a broken mesh

  /// Replaces the mesh and its cavities by those of a later step, and adds its warnings and
  /// defects.
  void takeStep(CheckedMesh step) {
    mesh = std::move(step.mesh);
    cavities = std::move(step.cavities);
    warnings.insert(warnings.end(), step.warnings.begin(), step.warnings.end());
    addDefects(step.defects);
    is_wrapped = is_wrapped || step.is_wrapped;
  }
  void addDefects(const std::vector<MeshDefect>& more) {
    defects.insert(defects.end(), more.begin(), more.end());
  }
};

/// Returns a mesh without defects. @throws std::runtime_error in one line that begins with `name`,
/// with the first defect of any other.
inline CheckedMesh requireSound(CheckedMesh checked, const std::string& name) {
  if (!checked.defects.empty()) raiseInputError(name, checked.defects.front().text);
  return checked;
}

}  // namespace ambient
