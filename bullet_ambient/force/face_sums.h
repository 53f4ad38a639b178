#pragma once

#include <cstddef>

#include "bullet_ambient/spatial/instruction_set.h"

namespace ambient {

// The sums over faces behind computeFaceLoads(). Plain data only: the kernels are compiled once per
// instruction set, and must not share an inline function with the rest of the program.

/// The columns of a FaceTable.
struct FaceColumns {
  const double* normal[3];
  const double* centroid[3];
  const double* area;
  std::size_t size;
  const double* sharpness = nullptr;  ///< not null: the form law
};

/// The surface of the fluid, docs/theory.md eq. (59).
struct FaceCut {
  double normal[3];  ///< out of the fluid
  double height;     ///< of the plane above the origin [m]
};

/// Motion of the body relative to the ambient flow, and where the flow separates.
struct FaceMotion {
  double angular[3];             ///< [rad/s]
  double linear[3];              ///< [m/s]
  double signed_cosine_sq;       ///< -cos(alpha) |cos(alpha)|; 0 at a right angle
  double sine_sq;                ///< sin^2(alpha)
  const FaceCut* cut = nullptr;  ///< null: all is in the fluid
};

/// Torque first. With the slip velocity u_s of attached faces and t = -u_s; by the form law q in
/// place of |t|^2, eq. (44).
struct FaceSums {
  double pressure[6];  ///< sum |t|^2 A (c x n, n) [m^5/s^2, m^4/s^2]
  double friction[6];  ///< sum |t|^0.8 A (c x t, t); 0 if not asked for
};

/// Face i is summed into lane i mod 8, the lanes pairwise in the end, and no operation is fused:
/// all instruction sets give the same bits.
using SumFaces = FaceSums (*)(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;

FaceSums sumFacesBaseline(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;
FaceSums sumFacesAvx2(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;
FaceSums sumFacesAvx512(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;
constexpr Kernels<SumFaces> kSumFaces{sumFacesBaseline, sumFacesAvx2, sumFacesAvx512};

}  // namespace ambient
