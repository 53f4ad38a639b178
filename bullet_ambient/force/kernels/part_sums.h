#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/blocks.h"

namespace ambient {

// Sums over the patches of eq. (60), here called parts, for WettedParts. Plain data only, see
// single_sums.h.

/// Water surface. A point at depth zeta > 0 has the weight zeta / (zeta + reach), docs/theory.md
/// eq. (60); `reach`: kappa H [m].
struct PartPlane {
  double normal[3];
  double height;  ///< height of the plane along the normal [m]
  double reach;
};

/// Symmetric 6x6 matrix: upper triangle, row by row.
struct PartInertia {
  double entries[PartBlock::kEntries];
};
/// Derivatives of x.K_w x with respect to the plane, for F_K of eq. (66).
struct PartGradient {
  double by_height;
  double by_normal[3];
};

/// Kernels of one instruction set. Part i goes to lane i mod 8; lanes are added pairwise at the
/// end. No operation is fused: all instruction sets give the same bits.
struct PartKernel {
  /// Returns the weighted sum of eq. (60).
  PartInertia (*inertia)(const PartBlocks&, const PartPlane&) noexcept;
  /// Returns the derivatives for a twist x. `products`: x_i x_j in the order of PartInertia,
  /// doubled off the diagonal.
  PartGradient (*gradient)(const PartBlocks&, const PartPlane&,
                           const double (&products)[PartBlock::kEntries]) noexcept;
};

extern const PartKernel kPartKernelBaseline, kPartKernelAvx2, kPartKernelAvx512;
extern const Kernels<const PartKernel*> kPartKernels;

}  // namespace ambient
