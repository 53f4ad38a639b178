#pragma once

#include "preprocess/potential_flow/operators/far_moments.h"

namespace ambient {

/// Vertex values (V x 6) of the continuous piecewise linear functions with the given moments: the
/// L2 projection. 0 at vertices without a panel. Cost: one sparse factorisation.
Eigen::Matrix<double, Eigen::Dynamic, 6> projectOnVertices(const PanelSurface& surface,
                                                           const PanelMoments& moments);

}  // namespace ambient
