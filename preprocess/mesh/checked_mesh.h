#pragma once

#include <string>
#include <utility>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A mesh that has passed a check, perhaps with triangles turned round or vertices removed, and
/// warnings about such changes, one line each.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
  /// Closed parts inside the body, normals into the cavity; the fluid outside does not see them.
  TriangleMesh cavities = {};

  /// Replaces the mesh and its cavities by those of a later step, and adds its warnings.
  void takeStep(CheckedMesh step) {
    mesh = std::move(step.mesh);
    cavities = std::move(step.cavities);
    warnings.insert(warnings.end(), step.warnings.begin(), step.warnings.end());
  }
};

}  // namespace ambient
