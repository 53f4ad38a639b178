#pragma once

#include "bullet_ambient/fluid_body/hull_block.h"
#include "bullet_ambient/spatial/instruction_set.h"

namespace ambient {

// The sums over a hull behind computeWetVolume(). Plain data only, as in face_sums.h.

/// A water surface, and right-handed axes in it: e_1 x e_2 = s.
struct HullPlane {
  double normal[3];   ///< s
  double axes[2][3];  ///< e_1, e_2
  double height;      ///< h [m]
};

/// Over the wet part of a hull, docs/theory.md eq. (54); moments about the foot h s of the origin,
/// along the axes.
struct HullSums {
  double volume;     ///< V
  double depth;      ///< W
  double moment[2];  ///< of V; along s it has h V - W of S
  double area;       ///< of the waterplane, A_w
  double first[2];   ///< P_1
  double second[3];  ///< P_2: xx, xy, yy
};

/// Least and largest s.z over the corners of a hull [m].
struct HullExtent {
  double low, high;
};

/// Triangle i of a block that is cut is summed into lane i, block i of the wet ones into lane i mod
/// 8, lanes pairwise in the end, and no operation is fused: all instruction sets give the same
/// bits.
struct HullKernel {
  HullSums (*sums)(const HullBlocks&, const HullPlane&) noexcept;
  HullExtent (*extent)(const HullCorners&, const double (&direction)[3]) noexcept;
};

extern const HullKernel kHullKernelBaseline, kHullKernelAvx2, kHullKernelAvx512;
constexpr Kernels<const HullKernel*> kHullKernels{&kHullKernelBaseline, &kHullKernelAvx2,
                                                  &kHullKernelAvx512};

}  // namespace ambient
