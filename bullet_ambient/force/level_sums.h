#pragma once

#include <cstddef>

#include "bullet_ambient/fluid_body/cluster_block.h"
#include "bullet_ambient/force/single_sums.h"

namespace ambient {

// The sums over clusters behind computeLevelLoads(); the rules of single_sums.h.

/// Pressure: the clusters' share of eq. (42), without the even part. Friction as in FaceSums.
using SumClusters = FaceSums (*)(const ClusterBlock* blocks, std::size_t count, const SingleMotion&,
                                 bool with_friction) noexcept;

FaceSums sumClustersBaseline(const ClusterBlock*, std::size_t, const SingleMotion&, bool) noexcept;
#if defined(__x86_64__)
FaceSums sumClustersAvx2(const ClusterBlock*, std::size_t, const SingleMotion&, bool) noexcept;
FaceSums sumClustersAvx512(const ClusterBlock*, std::size_t, const SingleMotion&, bool) noexcept;
#endif

/// The kernel for an instruction set; null if this processor does not have it.
SumClusters sumClustersFor(InstructionSet instruction_set) noexcept;

}  // namespace ambient
