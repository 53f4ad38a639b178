#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/warnings.h"

AMBIENT_BEGIN

// States of several bodies of Bullet, read side by side. `count`: at most kFlightsTogether.

/// Reads the orientations of bodies, B to W, and turns one twist of each into its axes.
void readAttitudes(AmbientBody* const* bodies, const Twist* twists_W, int count,
                   Quaternion* orientations, Twist* twists_B) noexcept;
/// Computes them from matrices B to W that are orthogonal up to rounding.
void computeAttitudes(const btMatrix3x3* const* rotations, const Twist* twists_W, int count,
                      Quaternion* orientations, Twist* twists_B) noexcept;

/// Bodies at the start of a step.
struct StartStates {
  Twist twists_W[kFlightsTogether];  ///< velocities in Bullet
  RigidState states[kFlightsTogether];
  Surroundings surroundings[kFlightsTogether];
};

void readStartStates(AmbientBody* const* bodies, int count, StartStates& starts) noexcept;

/// Begins the substep of a body that the solver meets: resets its outcome, reports a missing
/// action, calls prepareFluid(). Returns true if the fluid acts on the body.
bool prepareStep(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept;

/// Finds the region of a body or link among those of `bodies`, and rebuilds a stale model. Returns
/// true if the fluid acts on it. `now`: motion at the start of the substep; null: it is in no
/// region. @pre `now` is set if mayBeInRegion()
bool prepareFluid(AmbientBody& ambient, const MotionView* now, const Twist& twist_W,
                  const InverseMass& mass, AmbientBodies& bodies, double time_step) noexcept;

/// Disables the body for a substep whose duration is not finite, in which Bullet must not move it.
void disable(AmbientBody& ambient, AmbientBodies& bodies) noexcept;

/// Restores the activation state of the body after such a substep.
void restoreActivation(AmbientBody& ambient) noexcept;

/// Sets a velocity that is not finite to zero, before constraint rows carry it to other bodies.
/// Counts and reports it.
void stopIfNotFinite(AmbientBody& ambient, Warnings& warnings) noexcept;

/// True if a body moves by more than a hundredth of its size [m] within the 2 s that Bullet waits
/// before it sleeps (gDeactivationTime).
inline bool drifts(double speed, double spin, double size) noexcept {
  constexpr double kRestingTravel = 0.01, kRestingTime = 2;
  return kRestingTime * (speed + size * spin) > kRestingTravel * size;
}

/// Keeps Bullet from putting a body to sleep whose fluid changes with time, or that drifts freely
/// or floats: it may rest only when it does not drift and, unless joints or contacts hold it, would
/// not turn over.
void keepAwake(AmbientBody& ambient, Outcome kind) noexcept;

/// Flies up to kFlightsTogether bodies from `starts` over `time_step` [s] and keeps where they
/// end. Writes the velocity changes in world axes that make Bullet's integrateTransform reach those
/// poses, docs/theory.md eq. (29). A flight that is not finite leaves its body adrift, and nothing
/// is kept.
void beginFlights(AmbientBody* const* bodies, const StartStates& starts, int count,
                  double time_step, Twist* changes_W) noexcept;

/// Replaces the velocity change by gravity and applied forces that Bullet has computed for the dry
/// body. Bullet adds it when it writes velocities back. World axes, [rad/s] and [m/s].
inline void setExternalImpulse(btSolverBody& solver_body, const Twist& change_W) {
  solver_body.m_externalTorqueImpulse = toBullet(change_W.angular);
  solver_body.m_externalForceImpulse = toBullet(change_W.linear);
}

/// A body that no row moves.
struct FreeBody {
  AmbientBody* ambient;
  btSolverBody* solver_body = nullptr;  ///< null: Bullet does not convert the body
};

/// Flies up to kFlightsTogether bodies from where they are, as beginFlights(), and gives Bullet the
/// velocities that bring them to the ends.
void flyBodies(const FreeBody* bodies, int count, double time_step) noexcept;

/// Reports a flight that is not finite, or whose step is too long.
inline void reportFlight(const AmbientBody& ambient, Warnings& warnings) noexcept {
  if (ambient.outcome.kind != Outcome::kFlown) warnings.warnOnce(Warning::kNotFinite);
  if (ambient.outcome.is_too_long) warnings.warnOfLongSteps(*ambient.def);
}

/// After Bullet has moved the body: gives it the velocity and the attitude of the end of its
/// flight; where continuous collision detection has stopped it, the attitude there.
void endFlight(AmbientBody& ambient, double time_step) noexcept;

AMBIENT_END
