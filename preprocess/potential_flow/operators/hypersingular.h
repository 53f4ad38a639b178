#pragma once

#include <Eigen/Core>

#include "preprocess/potential_flow/operators/near_moments.h"

namespace ambient {

/// Numbers of the unknowns at the vertices. All vertices of triangles have one, except those on the
/// boundary of a sheet.
struct Unknowns {
  std::vector<int> of_vertex;  ///< number of the unknown, or -1
  int count = 0;
};

Unknowns numberUnknowns(const PanelSurface& surface);

/// Assembles W (U x U, positive semi-definite; its kernel: constants on each closed component);
/// fills only the lower triangle: W_ij = 1/(4 pi) sum over panels t at i, s at j of (curl h_i .
/// curl h_j) int_t int_s 1/r; docs/theory.md eq. (8), (9). Cost: O(panels^2) time, U^2 numbers of
/// memory.
Eigen::MatrixXd assembleHypersingular(const PanelSurface& surface, const Unknowns& unknowns,
                                      const NearPanels& near, int threads);

/// Makes W regular: adds s m m^T for the constant m on each closed component, whose vertices all
/// carry an unknown. s is of the size of W's diagonal.
void fillKernel(const PanelSurface& surface, const Unknowns& unknowns, Eigen::MatrixXd& W);

/// Assembles B (U x 6): int h_i n.(v + w x z) for the six unit motions, rotation first, exact;
/// docs/theory.md eq. (8).
Eigen::Matrix<double, Eigen::Dynamic, 6> assembleNormalVelocity(const PanelSurface& surface,
                                                                const Unknowns& unknowns);

}  // namespace ambient
