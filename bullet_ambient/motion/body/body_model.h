#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/passivity_guard.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/motion/body/dual_pair.h"
#include "bullet_ambient/motion/body/even_response.h"
#include "bullet_ambient/motion/body/flow_along_body.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

class SurfaceLoads;

/// Mass [kg] and rotational inertia about the centre of mass in B's axes [kg m^2].
struct MassProperties {
  double mass = 0;
  Matrix3 inertia = Matrix3::Zero();
};

/// Parameters of the equations of motion for one body in one medium; constant until body or medium
/// change. Frame: body frame B at the centre of mass.
struct BodyModel {
  Matrix6 inertia;                    ///< K = K_body + rho K_fluid, docs/theory.md eq. (3); SPD
  Matrix6 inverse_inertia;            ///< K^-1
  bool has_diagonal_inertia = false;  ///< K and K^-1 are diagonal: three planes of symmetry
  EvenResponse even_response;         ///< isotropic response k' of eq. (28b)
  double mass = 0;                    ///< mass of the body without fluid [kg]
  double displaced_mass = 0;          ///< m_f = rho volume [kg]
  Vector3 centre_of_volume;           ///< in B [m]
  std::shared_ptr<const SurfaceLoads> loads;  ///< null: no surface loads
  FrameOffset load_frame;                     ///< pose in B of the frame of the loads
  double reference_length = 0;                ///< sqrt(area) [m]
  double largest_mass = 0;                    ///< largest eigenvalue of K's translation block [kg]
};

/// Throws std::invalid_argument, naming value and limit, if the medium is not physical.
void checkMedium(const FluidBody& fluid_body, const Medium& medium);

/// Builds the model. `fluid_frame`: pose of F in B; `loads`: of this body and medium, or null.
/// @throws std::invalid_argument, naming value and limit, if shape, mass, inertia or medium are not
/// physical.
BodyModel makeBodyModel(const FluidBody& fluid_body, const FrameOffset& fluid_frame,
                        const MassProperties& mass, const Medium& medium,
                        std::shared_ptr<const SurfaceLoads> loads);

/// The share of pressure and friction in B for a twist in B relative to the ambient flow, after
/// removePositivePower(); docs/theory.md eq. (13) to (17) and (20). `load_share`: factor of eq.
/// (51d). `flow`: how the fluid moves along the body, null: as one; see loadAlong().
SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist,
                               double load_share = 1, const FlowAlongBody* flow = nullptr) noexcept;

/// Pair of a twist x and its momentum K x.
inline DualPair pairOfTwist(const BodyModel& model, const Vector6& x) {
  if (model.has_diagonal_inertia) return {x, model.inertia.diagonal().cwiseProduct(x)};
  return {x, model.inertia * x};
}

/// Pair of a momentum (or wrench) m and its twist (or acceleration) K^-1 m.
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
