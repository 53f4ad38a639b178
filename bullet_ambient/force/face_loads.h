#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

class PackedFaces;
struct SurfacePlane;

/// cos(alpha) of a separation angle [rad]; exactly 0 at pi/2, where std::cos leaves 6e-17.
double separationCosine(double separation_angle);

/// What the surface loads depend on besides shape and motion.
struct LoadSettings {
  double density = 0;            ///< fluid density [kg/m^3]
  double viscosity = 0;          ///< dynamic viscosity [Pa s]
  double separation_cosine = 0;  ///< cos(alpha), alpha in [pi/2, pi]; see separationCosine()
  bool skin_friction = true;     ///< false, or viscosity 0: friction is not computed
  PressureLaw law = PressureLaw::kPublished;

  /// Of a slip of 1 m/s; 0: no friction.
  double reynoldsPerSpeed(double reference_length) const noexcept {
    return skin_friction && viscosity > 0 ? density * reference_length / viscosity : 0;
  }
};

/// Surface loads on a body, split by origin.
struct FaceLoads {
  Wrench pressure;
  Wrench friction;

  Wrench total() const { return pressure + friction; }
};

/// Dynamic pressure with flow separation, and skin friction, of every face; docs/theory.md eq. (13)
/// to (17), Padilla et al. 2025 with the corrections listed there, or (43) and (44) in place of
/// (15). Frame: fluid body frame F (twist, wrench about F's origin). `relative_twist` is that of
/// the body relative to the ambient flow; `reference_length` [m], the length in the Reynolds
/// number, is sqrt(total area). Fixed summation order without fused operations: the same bits on
/// every machine. Pressure is homogeneous of degree 2 in the twist, friction of degree 1.8. Cost
/// O(F), about 1.5 ns per face, 3 ns with friction (AVX2); allocates nothing. A twist that is not
/// finite gives loads that are not finite, or 0.
/// With a `plane` only what is below it is loaded: areas times their wet shares, eq. (59).
/// @pre all columns of `faces` have one length, that of the sharpness too by the form law.
FaceLoads computeFaceLoads(const FaceTable& faces, double reference_length,
                           const Twist& relative_twist, const LoadSettings& settings,
                           const SurfacePlane* plane = nullptr) noexcept;

/// The total of computeFaceLoads() in single precision: on large meshes 0.45 ns per face with AVX2,
/// 0.7 with friction, 1.2 times that by the form law. At alpha = pi/2 blocks of faces in the lee
/// are left out.
/// @pre `faces` have their sharpness by the form law, and only then. Arguments as there.
/// Rounding errors grow with the velocity of the faces, not with their slip: about 1e-6 of 1/2 rho
/// sum A_i |u_s,i| |u_i|, and a face at the separation angle may fall on the other side of it. No
/// range is lost: the motion is scaled before it is rounded. The same bits on every machine.
Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings,
                       const SurfacePlane* plane = nullptr) noexcept;

/// The total of computeFaceLoads() on the clusters of a level, docs/theory.md eq. (36) to (39),
/// with the error that the level states. Arguments as there; `settings.separation_cosine` must be
/// that of the level. The pressure may feed energy to the body: guard it. Cost: level.cost faces,
/// whatever the mesh; allocates nothing. The same bits on every machine.
Wrench computeLevelLoad(const LoadLevel& level, double reference_length,
                        const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
