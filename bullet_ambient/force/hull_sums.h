#pragma once

#include "bullet_ambient/fluid_body/hull_block.h"
#include "bullet_ambient/force/instruction_set.h"

namespace ambient {

// The sums over a hull behind computeWetVolume(). Plain data only, as in face_sums.h.

/// A water surface, and right-handed axes in it: e_1 x e_2 = s.
struct HullPlane {
  double normal[3];   ///< s
  double axes[2][3];  ///< e_1, e_2
  double height;      ///< h [m]
};

/// Over the wet part of a hull, docs/theory.md eq. (54); moments of the waterplane about the foot
/// h s of the origin, along the axes.
struct HullSums {
  double volume;     ///< V
  double depth;      ///< W
  double moment[3];  ///< S - s W
  double area;       ///< of the waterplane, A_w
  double first[2];   ///< P_1
  double second[3];  ///< P_2: xx, xy, yy
};

/// Triangle i of a cut block is summed into lane i mod 8, block i of the wet ones likewise, lanes
/// pairwise in the end, and no operation is fused: all instruction sets give the same bits.
using SumHull = HullSums (*)(const HullBlocks&, const HullPlane&) noexcept;

HullSums sumHullBaseline(const HullBlocks&, const HullPlane&) noexcept;
HullSums sumHullAvx2(const HullBlocks&, const HullPlane&) noexcept;
HullSums sumHullAvx512(const HullBlocks&, const HullPlane&) noexcept;
constexpr Kernels<SumHull> kSumHull{sumHullBaseline, sumHullAvx2, sumHullAvx512};

}  // namespace ambient
