#pragma once

#include <vector>

#include "preprocess/resistance/surface_flow.h"

namespace ambient {

/// What boundary layers make of the flow past a body that moves one way; docs/theory.md eq. (97) to
/// (99). On its frontal area and D_A, without unit. The first four of a state of the layers:
/// laminar; laminar to its separation and turbulent from there (a bubble); turbulent from the nose,
/// smooth and rough (four times the growth).
struct SeparationWay {
  double wake_laminar = 0, wake_bubble = 0, wake_turbulent = 0,
         wake_rough = 0;  ///< k_L, k_B, k_1, k_4
  double thickness =
      0;  ///< N: momentum thickness where the laminar layer leaves, over D_A Re^(-1/2)
  double friction_laminar = 0;    ///< f_L, times Re^(-1/2)
  double friction_bubble = 0;     ///< f_B, times Re^(-1/5)
  double friction_turbulent = 0;  ///< f_T, times Re^(-1/5)
};

/// The numbers of one way, and how much of the base separates, on the area seen along the motion.
struct LayerSums {
  SeparationWay way;
  double base = 0;  ///< area behind laminar separation, projected along the motion [D_A^2]
  double smooth_base =
      0;  ///< of it, that of streamlines that left a smooth surface and crossed no sharp edge
};

/// Follows laminar and turbulent layers downstream along the streamlines of a flow. Cost O(V log
/// V).
/// @param flow of the body's motion along the unit vector `motion`, by vertex of the surface
LayerSums followLayers(const CutSurface& surface, const std::vector<VertexFlow>& flow,
                       const Eigen::Vector3d& motion);

}  // namespace ambient
