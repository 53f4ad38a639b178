#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A closed part of a collision shape, in the shape's frame, with the volume of the smooth body.
struct Solid {
  TriangleMesh mesh;  ///< triangles for the loads
  TriangleMesh
      flow;  ///< finer triangles of the same body for the flow alone; empty: `mesh` is used
  TriangleMesh coarse_flow;  ///< coarser triangles for the flow: from these to `flow`, the error
                             ///< shrinks as 1 / flow_ratio
  double flow_ratio =
      0;  ///< ratio of the numbers of triangles, to extrapolate the result; 0: no extrapolation
  TriangleMesh cavities;  ///< closed surfaces inside the body; they only matter to the uniform mass
  /// Added mass from a closed form or a table, about the shape's origin, per unit density; none:
  /// neither exists.
  std::optional<Matrix6> added_mass;
  bool is_polyhedron = false;         ///< its flat sides are the body's, and no approximation
  double sphere_radius = 0;           ///< radius of a sphere [m]; 0: any other shape
  std::string name;                   ///< name of the part: "crane: child 1: child 0 (Box)"
  std::vector<std::string> warnings;  ///< what a user should know about it, one line each
};

}  // namespace ambient
