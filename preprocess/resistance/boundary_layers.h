#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/resistance/surface_flow.h"

namespace ambient {

/// Where smooth layers leave along one way: share of the body's length along the motion, from its
/// front; the mean over the line along which they leave. 1: nowhere.
struct LayerPlaces {
  double laminar = 1, turbulent = 1;
};

/// The numbers of one way, and how much of the base separates, on the area seen along the motion.
struct LayerSums {
  SeparationWay way;
  LayerPlaces leaves_at;
  double base = 0;  ///< area behind laminar separation, projected along the motion [D_A^2]
  double smooth_base =
      0;  ///< of it, that of streamlines that left a smooth surface and crossed no sharp edge
  /// False where a friction came out negative, as velocities at edges and in hollows may that the
  /// mesh does not resolve: it is 0.
  bool is_resolved = true;
};

/// Follows laminar and turbulent layers downstream along the streamlines of a flow. Cost O(V log
/// V).
/// @param flow of the body's motion along the unit vector `motion`, by vertex of the surface
LayerSums followLayers(const CutSurface& surface, const std::vector<VertexFlow>& flow,
                       const Eigen::Vector3d& motion);

}  // namespace ambient
