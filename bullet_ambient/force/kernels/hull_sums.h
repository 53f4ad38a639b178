#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/blocks.h"

namespace ambient {

/// Water surface, and right-handed axes in the surface: e_1 x e_2 = s.
struct HullPlane {
  double normal[3];   ///< s
  double axes[2][3];  ///< e_1, e_2
  double height;      ///< h [m]
};

// Sums over a hull for computeWetVolume(). Plain data only, see single_sums.h.

/// Sums over the wet part of a hull, docs/theory.md eq. (54), (58); moments along e_1 and e_2,
/// about the point h s of the plane.
struct HullSums {
  double volume;     ///< V [m^3]
  double depth;      ///< W [m^4]
  double moment[2];  ///< S along e_1 and e_2 [m^4]; along s: s.S = h V - W
  double area;       ///< area A_w of the waterplane [m^2]
  double first[2];   ///< P_1 [m^3]
  double second[3];  ///< P_2: xx, xy, yy [m^4]
};

/// Smallest and largest s.z over the corners of a hull [m].
struct HullExtent {
  double low, high;
};

/// Kernels of one instruction set. Triangle i of a cut block goes to lane i, wholly wet block i to
/// lane i mod 8; lanes are added pairwise at the end. No operation is fused: all instruction sets
/// give the same bits.
struct HullKernel {
  HullSums (*sums)(const HullBlocks&, const HullPlane&) noexcept;
  HullExtent (*extent)(const HullCorners&, const double (&direction)[3]) noexcept;
};

extern const HullKernel kHullKernelBaseline, kHullKernelAvx2, kHullKernelAvx512;
extern const Kernels<const HullKernel*> kHullKernels;

}  // namespace ambient
