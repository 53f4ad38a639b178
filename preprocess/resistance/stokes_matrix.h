#pragma once

#include <Eigen/Core>
#include <vector>

#include "preprocess/potential_flow/surface/panel.h"

namespace ambient {

/// Computes int_T (I/r + r r^T/r^3) dy, r = x - y, of a panel T [length] at up to 16 points x,
/// exact for every x, on the panel too; docs/theory.md eq. (94). Symmetric.
void computeStokeslets(const Panel& panel, const Eigen::Vector3d* points, std::size_t count,
                       Eigen::Matrix3d* tensors);

/// Assembles the matrix of the Stokes equation (93) with one force per area on each group of
/// panels, tested by the same groups: 3 G x 3 G, symmetric [length^3]. Panels nearer than twice the
/// sum of their radii are integrated over three points and the panel in closed form, others over
/// one, whole groups that are farther from a panel over one point too; the mean of both orders. The
/// bits do not depend on the number of threads. Cost: 300 panels take 0.05 s of one core.
/// @param group number of the group of each panel, 0 <= group < count; none is empty
Eigen::MatrixXd assembleStokesMatrix(const std::vector<Panel>& panels,
                                     const std::vector<int>& group, int count, int threads);

}  // namespace ambient
