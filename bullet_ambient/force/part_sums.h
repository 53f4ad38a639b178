#pragma once

#include "bullet_ambient/fluid_body/part_block.h"
#include "bullet_ambient/spatial/instruction_set.h"

namespace ambient {

// The sums over parts of the added mass behind WettedParts. Plain data only, as in face_sums.h.

/// How the surface of the water weights the depth zeta of a part, docs/theory.md eq. (60):
/// zeta / (zeta + reach).
struct PartPlane {
  double normal[3];
  double height;  ///< [m]
  double reach;   ///< [m]
};

/// Symmetric 6x6, rows from the diagonal on.
struct PartInertia {
  double entries[PartBlock::kEntries];
};
/// Of x.K x, for the products of a twist: x_i x_j in that order, twice off the diagonal.
struct PartGradient {
  double by_height;
  double by_normal[3];
};

/// Part i is summed into lane i mod 8, lanes pairwise in the end, and no operation is fused: all
/// instruction sets give the same bits.
struct PartKernel {
  PartInertia (*inertia)(const PartBlocks&, const PartPlane&) noexcept;
  PartGradient (*gradient)(const PartBlocks&, const PartPlane&,
                           const double (&products)[PartBlock::kEntries]) noexcept;
};

extern const PartKernel kPartKernelBaseline, kPartKernelAvx2, kPartKernelAvx512;
constexpr Kernels<const PartKernel*> kPartKernels{&kPartKernelBaseline, &kPartKernelAvx2,
                                                  &kPartKernelAvx512};

}  // namespace ambient
