#pragma once

#include <cstddef>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/force/law/pressure_law.h"
#include "bullet_ambient/force/law/wing_pressure.h"

namespace ambient {

// Sums over faces for computeFaceLoads(). Plain data only: the kernels are compiled once per
// instruction set, and must not share an inline function with the rest of the program.

/// Columns of a FaceTable.
struct FaceColumns {
  const double* normal[3];
  const double* centroid[3];
  const double* area;
  std::size_t size;
  const double* sharpness = nullptr;  ///< for the form law
};

/// Water surface as a plane in F, for the wet shares of docs/theory.md eq. (59).
struct FaceCut {
  double normal[3];  ///< out of the fluid
  double height;     ///< height of the plane above F's origin along the normal [m]
};

/// Motion of the body relative to the ambient flow, in F, and the separation angle.
struct FaceMotion {
  double angular[3];             ///< [rad/s]
  double linear[3];              ///< [m/s]
  double signed_cosine_sq;       ///< -cos(alpha) |cos(alpha)|; 0 at a right angle
  double sine_sq;                ///< sin^2(alpha)
  const FaceCut* cut = nullptr;  ///< null: all faces are in the fluid
  PressureLaw law = PressureLaw::kPublished;
  const WingFactors<double>* wing = nullptr;  ///< for the form law; null: neither wing nor slender
  double pitching[3] = {};                    ///< a of eq. (43d)
  double centre[3] = {};                      ///< centre of volume [m]
  double pitching_rate = 0;                   ///< a.w [rad/s]
  double slip_share = 0;                      ///< tau of eq. (43e)
};

/// Sums over attached faces, torque first, without the factor -rho/2; t = -u_s. With the form law,
/// q + q_L replaces |t|^2 in the pressure, eq. (44).
struct FaceSums {
  double pressure[6];  ///< sum |t|^2 A (c x n, n) [m^5/s^2, m^4/s^2]
  double friction[6];  ///< sum |t|^0.8 A (c x t, t); 0 without with_friction
  double pitch;        ///< sum q_L A mu of wings, eq. (43d)
};

/// Sums all faces. Face i goes to lane i mod 8; lanes are added pairwise at the end. No operation
/// is fused: all instruction sets give the same bits.
using SumFaces = FaceSums (*)(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;

FaceSums sumFacesBaseline(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;
FaceSums sumFacesAvx2(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;
FaceSums sumFacesAvx512(const FaceColumns&, const FaceMotion&, bool with_friction) noexcept;
extern const Kernels<SumFaces> kSumFaces;

}  // namespace ambient
