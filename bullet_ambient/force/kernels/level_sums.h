#pragma once

#include <cstddef>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/cluster_block.h"
#include "bullet_ambient/force/kernels/load_sums.h"

namespace ambient {

// Sums over clusters for computeLevelLoad(). Lanes and rounding: see single_sums.h.

/// Clusters of a LoadLevel, docs/theory.md section 9.
struct LevelColumns {
  const ClusterBlock* blocks;
  std::size_t count;
  const double* even;  ///< T of eq. (36): 6 x 21, see addEvenPart()
};

/// Returns the sums of docs/theory.md eq. (38) and (39) without the factor -rho/2, in the units of
/// SingleMotion. `x`: the same twist in double precision.
using SumClusters = LoadSums (*)(const LevelColumns&, const double (&x)[6],
                                 const SingleMotion&) noexcept;

LoadSums sumClustersBaseline(const LevelColumns&, const double (&x)[6],
                             const SingleMotion&) noexcept;
LoadSums sumClustersAvx2(const LevelColumns&, const double (&x)[6], const SingleMotion&) noexcept;
LoadSums sumClustersAvx512(const LevelColumns&, const double (&x)[6], const SingleMotion&) noexcept;
extern const Kernels<SumClusters> kSumClusters;

}  // namespace ambient
