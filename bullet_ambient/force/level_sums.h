#pragma once

#include <cstddef>

#include "bullet_ambient/fluid_body/cluster_block.h"
#include "bullet_ambient/force/single_sums.h"

namespace ambient {

// The sums over clusters behind computeLevelLoad(); the rules of single_sums.h.

/// What a LoadLevel holds.
struct LevelColumns {
  const ClusterBlock* blocks;
  std::size_t count;
  const double* even;  ///< 6 x 21, column by column
};

/// Eq. (38) and (39) without -rho/2, in units of length and speed. `x`: the motion again.
using SumClusters = LoadSums (*)(const LevelColumns&, const double (&x)[6],
                                 const SingleMotion&) noexcept;

LoadSums sumClustersBaseline(const LevelColumns&, const double (&x)[6],
                             const SingleMotion&) noexcept;
LoadSums sumClustersAvx2(const LevelColumns&, const double (&x)[6], const SingleMotion&) noexcept;
LoadSums sumClustersAvx512(const LevelColumns&, const double (&x)[6], const SingleMotion&) noexcept;
constexpr Kernels<SumClusters> kSumClusters{sumClustersBaseline, sumClustersAvx2,
                                            sumClustersAvx512};

}  // namespace ambient
