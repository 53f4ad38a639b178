#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/packed/part_block.h"

namespace ambient {

// Sums over parts of the added mass for WettedParts. Plain data only, as in face_sums.h.

/// Surface of the water. A part at depth zeta > 0 has the weight zeta / (zeta + reach),
/// docs/theory.md eq. (60).
struct PartPlane {
  double normal[3];
  double height;  ///< [m]
  double reach;   ///< [m]
};

/// Symmetric 6x6 matrix: upper triangle, row by row.
struct PartInertia {
  double entries[PartBlock::kEntries];
};
/// Derivatives of x.K x; `products`: x_i x_j in the order of PartInertia, doubled off the diagonal.
struct PartGradient {
  double by_height;
  double by_normal[3];
};

/// Kernels of one instruction set. Part i goes to lane i mod 8; lanes are added pairwise at the
/// end. No operation is fused: all instruction sets give the same bits.
struct PartKernel {
  PartInertia (*inertia)(const PartBlocks&, const PartPlane&) noexcept;
  PartGradient (*gradient)(const PartBlocks&, const PartPlane&,
                           const double (&products)[PartBlock::kEntries]) noexcept;
};

extern const PartKernel kPartKernelBaseline, kPartKernelAvx2, kPartKernelAvx512;
constexpr Kernels<const PartKernel*> kPartKernels{&kPartKernelBaseline, &kPartKernelAvx2,
                                                  &kPartKernelAvx512};

}  // namespace ambient
