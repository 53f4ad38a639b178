#pragma once

#include <cstddef>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/cluster_block.h"
#include "bullet_ambient/force/kernels/load_sums.h"

namespace ambient {

// Sums over clusters for computeLevelLoad(); lanes and roundings as in single_sums.h.

/// Plain data of a LoadLevel.
struct LevelColumns {
  const ClusterBlock* blocks;
  std::size_t count;
  const double* even;  ///< 6 x 21, column by column
};

/// Sums (38) and (39) without -rho/2, in the units of the motion. `x`: the same motion in double.
using SumClusters = LoadSums (*)(const LevelColumns&, const double (&x)[6],
                                 const SingleMotion&) noexcept;

LoadSums sumClustersBaseline(const LevelColumns&, const double (&x)[6],
                             const SingleMotion&) noexcept;
LoadSums sumClustersAvx2(const LevelColumns&, const double (&x)[6], const SingleMotion&) noexcept;
LoadSums sumClustersAvx512(const LevelColumns&, const double (&x)[6], const SingleMotion&) noexcept;
constexpr Kernels<SumClusters> kSumClusters{sumClustersBaseline, sumClustersAvx2,
                                            sumClustersAvx512};

}  // namespace ambient
