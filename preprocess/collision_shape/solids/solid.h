#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A closed part of a collision shape, in the shape's frame, with the volume of the smooth body.
struct Solid {
  TriangleMesh mesh;  ///< the faces for the loads
  TriangleMesh flow;  ///< the same body, finer, for the flow alone; without triangles: `mesh`
  TriangleMesh coarse_flow;  ///< and coarser: the error shrinks as 1 / `flow_ratio` from here on
  double flow_ratio = 0;     ///< to `flow`, so that the result can be extrapolated; 0: it is not
  TriangleMesh cavities;     ///< closed, inside; they only matter to the uniform mass
  /// From a closed form or a table, about the shape's origin, if there is one, per unit density.
  std::optional<Matrix6> added_mass;
  /// The sum of what the parts have that it was united of, as far as it is known without solving.
  std::optional<Matrix6> parts_added_mass;
  double sphere_radius = 0;           ///< of a sphere [m]; 0: any other shape
  double margin_volume = 0;           ///< what Bullet's margin adds to it [m^3]
  std::string name;                   ///< of the part: "crane: child 1: child 0 (Box)"
  std::vector<std::string> warnings;  ///< what a user should know about it, one line each
};

}  // namespace ambient
