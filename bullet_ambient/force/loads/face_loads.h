#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

class PackedFaces;
struct ShapeFactors;

/// Drag coefficient of the form law along a unit vector, mean of both ways, on a frontal area
/// [m^2]; 0 without one. Cost O(F).
double ownDrag(const FaceTable& faces, const ShapeFactors& shape, const Vector3& direction,
               double frontal_area);

/// Cosine of a separation angle [rad]; exactly 0 at pi/2, for which std::cos returns 6e-17.
double separationCosine(double separation_angle);

/// Properties of medium and flow that surface loads depend on.
struct LoadSettings {
  double density = 0;            ///< fluid density [kg/m^3]
  double viscosity = 0;          ///< dynamic viscosity [Pa s]
  double separation_cosine = 0;  ///< cos(alpha), alpha in [pi/2, pi]; see separationCosine()
  bool skin_friction = true;     ///< false, or viscosity 0: friction is not computed
  PressureLaw law = PressureLaw::kPublished;
  /// The shape as the form law sees it. Null: a block, and by the published law. Not owned.
  const ShapeFactors* shape = nullptr;
  double roughness = 0;  ///< height of the roughness of the surface [m]

  /// Reynolds number at a slip of 1 m/s, reference_length [m]; 0: no friction.
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

/// Flow at one face and the resulting forces, in F.
struct FaceFlow {
  bool is_attached = false;
  Vector3 slip = Vector3::Zero();      ///< u_s, fluid relative to the wall [m/s]; 0 if separated
  Vector3 pressure = Vector3::Zero();  ///< force of the dynamic pressure [N]
  Vector3 friction = Vector3::Zero();  ///< force of skin friction [N]
  Vector3 moment = Vector3::Zero();    ///< of the lift of wings beside its force, eq. (43d) [N m]
};

/// Computes the flow at one face, docs/theory.md eq. (12) to (17), (43) to (44). The forces and
/// moments of all faces add up to computeFaceLoads(), which has the same arguments.
/// @pre face < faces.size()
FaceFlow computeFaceFlow(const FaceTable& faces, std::size_t face, double reference_length,
                         const Twist& relative_twist, const LoadSettings& settings) noexcept;

/// Sums dynamic pressure with flow separation, and skin friction, over all faces; docs/theory.md
/// eq. (13) to (17), Padilla et al. 2025 with the departures listed there. The form law has (43)
/// and (44) in place of (15). Frame F: twist of the body relative to the ambient flow, wrenches
/// about F's origin. `reference_length` [m] of the Reynolds number is sqrt(total area). A `plane`
/// in F scales the area of each face by its wet share, eq. (59); null: all faces are in the fluid.
/// Fixed summation order without fused operations: the same bits on every machine. Pressure is
/// homogeneous of degree 2 in the twist, friction of degree 1.8. Cost O(F), one face after another,
/// for references and fits: computeFaceLoad() is made for every step. Allocates nothing. A twist
/// that is not finite gives loads that are not finite, or 0.
/// @pre all columns of `faces` have one length; by the form law the sharpness, too.
FaceLoads computeFaceLoads(const FaceTable& faces, double reference_length,
                           const Twist& relative_twist, const LoadSettings& settings,
                           const SurfacePlane* plane = nullptr) noexcept;

/// Total of computeFaceLoads() in single precision, with the same arguments. Cost on large meshes:
/// 0.45 ns per face with AVX2, 0.7 with friction, 1.2 times as much by the form law, and 1.3 times
/// that on wings with friction. At alpha = pi/2 blocks of faces in the lee are skipped. Rounding
/// errors grow with the velocity of the faces, not with their slip: about 1e-6 of 1/2 rho sum A_i
/// |u_s,i| |u_i|. A face close to the separation angle may be classified otherwise. The motion is
/// scaled before it is rounded, so that nothing overflows. The same bits on every machine.
/// @pre `faces` were packed for settings.law and settings.shape
Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings,
                       const SurfacePlane* plane = nullptr) noexcept;

/// Faces spread over the sphere of radius 1 m about the origin, symmetric in all axes. All spheres
/// take the loads on their wet part from these, whatever faces they have. Made once per process.
std::shared_ptr<const FluidBody> unitSphere();

/// Surface of the fluid in another frame, with the sides of its pool.
struct SurfaceElsewhere {
  /// @param plane in that frame, but for its sides
  /// @param pose of that frame in F [m]
  /// @param unit of length in the result [m]
  SurfaceElsewhere(const SurfacePlane& plane, const FrameOffset& pose, double unit = 1) noexcept;
  SurfaceElsewhere(const SurfaceElsewhere&) = delete;  // plane points to sides

  SurfacePlane plane;
  PoolSides sides;
};

/// Returns the share of a face that is between the sides of a pool, by its centroid [m], unit
/// normal and the squared radius of a disc with its area [m^2]; docs/theory.md eq. (59) at each
/// side.
double shareInPool(const PoolSides& sides, const Vector3& centroid, const Vector3& normal,
                   double radius_sq) noexcept;

}  // namespace ambient
