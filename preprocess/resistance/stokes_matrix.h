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
/// panels, tested by the same groups: 3 G x 3 G, symmetric [length^3]. One panel of a pair is
/// integrated in closed form, the other over sixteen points if they touch, six if they are nearer
/// than eight times the sum of their radii, else one; with several panels a group three times, and
/// one for all of a farther group. The mean of both orders. The bits do not depend on threads. 300
/// panels take 0.05 s of one core.
/// @param group number of the group of each panel, 0 <= group < count; none is empty
Eigen::MatrixXd assembleStokesMatrix(const std::vector<Panel>& panels,
                                     const std::vector<int>& group, int count, int threads);

}  // namespace ambient
