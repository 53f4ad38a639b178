#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium.h"
#include "bullet_ambient/force/passivity_guard.h"
#include "bullet_ambient/motion/dual_pair.h"
#include "bullet_ambient/motion/even_response.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

class SurfaceLoads;

/// Mass [kg] and rotational inertia about the centre of mass in B's axes [kg m^2].
struct MassProperties {
  double mass = 0;
  Matrix3 inertia = Matrix3::Zero();
};

/// All that the equations of motion need to know of one body in one medium; constant between
/// changes of either. Frame: body frame B at the centre of mass.
struct BodyModel {
  Matrix6 inertia;                    ///< K = K_body + rho K_fluid, docs/theory.md eq. (3); SPD
  Matrix6 inverse_inertia;            ///< K^-1
  bool has_diagonal_inertia = false;  ///< both are: three planes of symmetry
  EvenResponse even_response;
  double mass = 0;                            ///< of the body without fluid [kg]
  double displaced_mass = 0;                  ///< m_f = rho volume [kg]
  Vector3 centre_of_volume;                   ///< in B [m]
  std::shared_ptr<const SurfaceLoads> loads;  ///< null: there are none
  FrameOffset load_frame;                     ///< that of the loads, in B
  double reference_length = 0;                ///< sqrt(area) [m]
  double largest_mass = 0;                    ///< largest eigenvalue of K's translation block [kg]
};

/// @throws std::invalid_argument, naming value and limit, if the medium is not physical.
void checkMedium(const FluidBody& fluid_body, const Medium& medium);

/// Builds the model. Cost: a few 6x6 factorisations. `loads`: of the same fluid body and medium.
/// @throws std::invalid_argument, naming value and limit, if shape, mass, inertia or medium are not
/// physical.
BodyModel makeBodyModel(const FluidBody& fluid_body, const FrameOffset& fluid_frame,
                        const MassProperties& mass, const Medium& medium,
                        std::shared_ptr<const SurfaceLoads> loads);

/// Pressure and friction on the body in B for a twist relative to the ambient flow, after the
/// passivity guard; docs/theory.md eq. (13) to (17) and (20).
SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist) noexcept;

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
