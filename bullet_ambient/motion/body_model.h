#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/medium.h"
#include "bullet_ambient/force/sphere_loads.h"
#include "bullet_ambient/motion/dual_pair.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

/// Surface loads by another law than docs/theory.md eq. (13) to (17), to compare with: a rival
/// model, a measured polar. What a body loses by them the integrators treat as they treat the
/// library's own.
class SurfaceLoadModel {
 public:
  virtual ~SurfaceLoadModel() = default;
  /// The load on the body for a twist relative to the ambient flow, both in F. Power that it feeds
  /// to the body is removed, eq. (20). Called from every thread that flies a body.
  virtual Wrench load(const FaceTable& faces, const Twist& relative_twist,
                      const LoadSettings& settings) const noexcept = 0;
};

/// Arithmetic of the loads on faces. What a face does is rounded; sums, and all else, are in
/// double.
enum class LoadPrecision {
  kSingle,  ///< half the time; moves bodies by a hundredth of what 1280 faces leave, or less
  kDouble,
};

/// How the flow follows the surface of one body.
struct FlowSettings {
  double separation_angle =
      1.5707963267948966;     ///< alpha in [pi/2, pi] [rad]; larger = more attachment
  bool skin_friction = true;  ///< turbulent 1/5-power law, docs/theory.md eq. (16)
  std::shared_ptr<const SurfaceLoadModel> model =
      nullptr;  ///< null: this library's pressure and friction
  LoadPrecision precision = LoadPrecision::kSingle;
  /// Allowed p99 error of reduced loads, LoadLevelError: the cheapest level of the fluid body for
  /// the separation angle that keeps it stands in for the faces. 0, or no such level: all faces.
  double maximum_load_error = 0;
};

/// Mass [kg] and rotational inertia about the centre of mass in B's axes [kg m^2].
struct MassProperties {
  double mass = 0;
  Matrix3 inertia = Matrix3::Zero();
};

/// All that the equations of motion need to know of one body in one medium; constant between
/// changes of either. Frame: body frame B at the centre of mass. Points into the fluid body and the
/// flow settings that it was made of, which must outlive it.
struct BodyModel {
  Matrix6 inertia;                    ///< K = K_body + rho K_fluid, docs/theory.md eq. (3); SPD
  Matrix6 inverse_inertia;            ///< K^-1
  bool has_diagonal_inertia = false;  ///< both are: three planes of symmetry
  double mass = 0;                    ///< of the body without fluid [kg]
  double displaced_mass = 0;          ///< m_f = rho volume [kg]
  Vector3 centre_of_volume;           ///< in B [m]
  FrameOffset fluid_frame;            ///< F in B
  LoadSettings loads;                 ///< how the faces are loaded
  double reference_length = 0;        ///< sqrt(area) [m]
  const FaceTable* faces = nullptr;   ///< in F
  std::shared_ptr<const PackedFaces> packed_faces;  ///< the same; null: loads in double precision
  const LoadLevel* level = nullptr;                 ///< of reduced loads; null: all faces
  double sphere_radius = 0;  ///< of a smooth sphere about centre_of_volume [m]; 0: faces
  std::shared_ptr<const SphereTable> sphere_table;  ///< null where it needs none
  const SurfaceLoadModel* load_model = nullptr;     ///< null: pressure and friction
  bool has_surface_loads = false;  ///< there are faces, a sphere or a load model, and a fluid

  double largest_mass = 0;  ///< largest eigenvalue of K's translation block [kg]
};

/// @throws std::invalid_argument, naming value and limit, if the medium is not physical.
void checkMedium(const FluidBody& fluid_body, const Medium& medium);

/// Builds the model. Cost: a few 6x6 factorisations.
/// @throws std::invalid_argument, naming value and limit, if mass, inertia, medium or flow settings
/// are not physical.
BodyModel makeBodyModel(const FluidBody& fluid_body, const FrameOffset& fluid_frame,
                        const MassProperties& mass, const Medium& medium, const FlowSettings& flow);

/// Pressure and friction on the body in B for a twist relative to the ambient flow, after the
/// passivity guard; docs/theory.md eq. (13) to (17) and (20).
struct SurfaceLoad {
  Wrench wrench;
  bool guarded = false;  ///< the guard removed a positive power
};
SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist) noexcept;

/// Faces or clusters that one evaluation of the surface loads sums; 0 for a sphere.
int facesPerLoad(const BodyModel& model) noexcept;

/// A twist with its momentum K x.
inline DualPair pairOfTwist(const BodyModel& model, const Vector6& x) {
  if (model.has_diagonal_inertia) return {x, model.inertia.diagonal().cwiseProduct(x)};
  return {x, model.inertia * x};
}

/// A momentum, or wrench, with its twist, or acceleration, K^-1 m.
inline DualPair pairOfMomentum(const BodyModel& model, const Vector6& m) {
  if (model.has_diagonal_inertia) return {model.inverse_inertia.diagonal().cwiseProduct(m), m};
  return {model.inverse_inertia * m, m};
}

/// Twice the kinetic energy of body and fluid, x.K x [J].
inline double inertiaNormSquared(const BodyModel& model, const Vector6& x) {
  const DualPair pair = pairOfTwist(model, x);
  return inner(pair, pair);
}

}  // namespace ambient
