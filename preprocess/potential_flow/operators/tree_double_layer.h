#pragma once

#include "preprocess/potential_flow/operators/cluster_expansions.h"
#include "preprocess/potential_flow/operators/far_moments.h"

namespace ambient {

/// The moments of computeExteriorMoments() for the panels of a tree: pair by pair between near
/// leaves, through expansions of dipoles between far clusters; docs/theory.md eq. (35). The same
/// bits for every number of threads.
PanelMoments computeExteriorMoments(const PanelTree& tree, const ClusterPairs& pairs, int degree,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads);

}  // namespace ambient
