#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/operators/solid_harmonics.h"

namespace ambient {

/// Panels `first` to `first + count - 1`.
struct PanelRange {
  Eigen::Index first, count;
};

/// Computes the moments that panels of PairKind::Far cause on each other, pair by pair, by Taylor
/// expansion between the centroids.
class FarMoments {
 public:
  static constexpr Eigen::Index kTargetsAtOnce = 16;  ///< columns of one product of matrices

  FarMoments(const PanelSurface& surface, const std::vector<PanelJump>& jumps);

  /// Adds to the moments of the targets (at most kTargetsAtOnce) the contributions of the source
  /// panels, times 4 pi. Leaves out the panels in near[k], ascending, for the k-th target.
  void add(const std::vector<PanelRange>& sources, const PanelRange& targets,
           const std::vector<NearPanels::Entry>* near, PanelMoments& moments) const;

 private:
  const PanelSurface& surface_;
  const std::vector<PanelJump>& jumps_;
  /// Rows 0-5 the mean jumps, row 6 ones, and per axis rows 7-12 that component of moment times
  /// gradient.
  std::array<Eigen::MatrixXd, 3> sources_;
};

/// Moments of the exterior potentials phi(x) = int dG/dn_y (mu(y) - mu(x)) dy that continuous
/// piecewise linear jumps mu (V x 6) stand for; docs/theory.md eq. (11). The difference under the
/// integral replaces the 1/2 of the jump relation, so thin bodies lose no digits.
/// Cost: O(panels^2) time.
PanelMoments computeExteriorMoments(const PanelSurface& surface, const NearPanels& near,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads);

/// The moments of computeExteriorMoments() for the panels of a tree: pair by pair between near
/// leaves, through expansions of dipoles between far clusters; docs/theory.md eq. (35). The same
/// bits for every number of threads.
PanelMoments computeExteriorMoments(const PanelTree& tree, const ClusterPairs& pairs, int degree,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads);

}  // namespace ambient
