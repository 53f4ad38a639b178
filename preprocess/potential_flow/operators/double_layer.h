#pragma once

#include <Eigen/Core>

#include "preprocess/potential_flow/operators/near_moments.h"

namespace ambient {

/// Moments of the exterior potentials phi(x) = int dG/dn_y (mu(y) - mu(x)) dy that continuous
/// piecewise linear jumps mu (V x 6) stand for; docs/theory.md eq. (11). The difference under the
/// integral replaces the 1/2 of the jump relation, so thin bodies lose no digits.
/// Cost: O(panels^2) time.
PanelMoments computeExteriorMoments(const PanelSurface& surface, const NearPanels& near,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads);

}  // namespace ambient
