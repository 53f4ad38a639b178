#pragma once

#include <optional>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A closed part of a collision shape, in the shape's frame, with the volume of the smooth body.
struct Solid {
  TriangleMesh mesh;  ///< the faces for the loads
  TriangleMesh flow;  ///< the same body, finer, for the flow alone; without triangles: `mesh`
  TriangleMesh coarse_flow;  ///< and coarser: the error shrinks as 1 / `flow_ratio` from here on
  double flow_ratio = 0;     ///< to `flow`, so that the result can be extrapolated; 0: it is not
  std::optional<Eigen::Vector3d> ball_centre;  ///< of a ball, which has a closed form [m]
};

}  // namespace ambient
