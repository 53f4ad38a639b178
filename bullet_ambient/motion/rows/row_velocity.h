#pragma once

#include <optional>

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"

namespace ambient {

/// Largest turn number m at which a step needs no bound of the energy, docs/theory.md eq. (31a).
constexpr double kSlowTurn = 0.5;

/// Change of velocity over one step that constraint rows are solved against, docs/theory.md eq.
/// (28): k by the forces at the start pose, plus X, half of the turning part, so that rows see the
/// middle of the turn. World axes: change of angular velocity [rad/s] and of the velocity of the
/// centre of mass [m/s].
struct RowVelocity {
  Twist change_W;            ///< k + X, and the acceleration of the ambient flow
  Twist turning_W;           ///< X of eq. (28), contained in change_W
  Twist isotropic_excess_W;  ///< k' - k of eq. (28b): with isotropic added mass minus the true one
  double turn_number = 0;    ///< m of eq. (28a); from 1 on X = 0, the turn is too large
  FlightCount count;
  /// N of eq. (124), which rows move in place of K, in B; none: K.
  std::optional<Matrix6> settled_inertia;
};

/// The load on a body when rows move it: what it cost, and RowVelocity::settled_inertia.
struct RowLoad {
  FlightCount count;
  Wrench mean_W;  ///< over the step, eq. (28f), world axes; 0 by eq. (23)
  std::optional<Matrix6> settled_inertia;
};

/// Returns N of docs/theory.md eq. (124) if the fluid settles the body, at a twist relative to it,
/// within a step of `duration` [s]; else none. `load`: of computeSurfaceLoad() at that twist.
std::optional<Matrix6> settledInertia(const BodyModel& model, const SurfaceLoad& load,
                                      const Twist& relative, double duration) noexcept;

// Bodies that rows may move are up to kFlightsTogether side by side, in RowLanes: setModels(),
// setStart() of each free body, FlightKernel::predictRowVelocity(); after the rows
// FlightKernel::conserve(), and after the move transport(). The bits of a body do not depend on the
// others.

/// Writes models into the first lanes, and makes these active. Others become 0.
void setModels(const BodyModel* const* models, int count, RowLanes& lanes) noexcept;
/// Writes the state of a body at the start of a step, and the forces and the load on it there.
/// `last_W`: the load in the last step, world axes; 0: not known. @pre setModels()
RowLoad setStart(const FlightTask& task, const RigidState& start, const Wrench& last_W, int lane,
                 RowLanes& lanes) noexcept;
/// Reads the result of FlightKernel::predictRowVelocity().
RowVelocity rowVelocityOf(const RowLanes& lanes, int lane, const RowLoad& load) noexcept;

/// Computes the change of one body alone.
RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept;

/// Returns the mean wrench in B of the kick by a load in fluid that turns with a body,
/// FlowAlongBody with one station, less FlowAlongBody::at_rest_B; docs/theory.md eq. (87). `load`:
/// of computeSurfaceLoad() at the twist `relative`.
Wrench meanLoadInTurningFluid(const FlightTask& task, const BodyModel& model, const Twist& relative,
                              const Wrench& load) noexcept;
/// True if the surroundings have such a fluid.
inline bool turnsWithFluid(const Surroundings& s) { return s.flow && s.flow->stations == 1; }

/// Bullet's factors of impulses along and about the axes of W: 1 free, 0 locked; other
/// values scale the impulse.
struct AxisFactors {
  Vector3 angular = Vector3::Ones();
  Vector3 linear = Vector3::Ones();

  bool areFree() const {
    for (int axis = 0; axis < 3; ++axis)
      if (angular[axis] != 1 || linear[axis] != 1) return false;
    return true;
  }
};

/// K (6x6, SPD, world axes) with rows and columns of locked axes replaced by those of the identity.
/// The result is SPD; its inverse is (P K P)^+ in the free axes, docs/theory.md eq. (30).
Matrix6 freeInertia(const Matrix6& inertia_W, const AxisFactors& factors);

/// K_eff^-1 = F (P K P)^+ F in world axes, docs/theory.md eq. (30), with F the factors and P the
/// projection on the axes that are not locked; symmetric positive semi-definite.
Matrix6 lockedInverse(const Matrix6& inertia_W, const AxisFactors& factors);

/// Returns a change of velocity in W without its parts along and about locked axes.
Twist onFreeAxes(const Twist& change_W, const AxisFactors& factors);

/// Returns what locks leave of a change of velocity that a free body would take, in W: K_eff^-1
/// times its momentum. `inertia`: K in B; R: B to W; change_B: of the free body, in B.
Twist lockedChange(const Matrix6& inertia, const Matrix3& R, const AxisFactors& factors,
                   const Vector6& change_B);

/// Like computeRowVelocity(), for a body with locked axes, along which the velocity stays. Contains
/// the whole turning part t, by the implicit midpoint rule, because such bodies have no free
/// flight; 0 instead of t beyond an turn_number of 1, with the limits 1 rad and 0.3 in eq. (28a).
RowVelocity computeLockedVelocity(const FlightTask& task, const RigidState& start,
                                  const AxisFactors& factors) noexcept;

}  // namespace ambient
