#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"

AMBIENT_BEGIN

/// The solver meets the body: begins its outcome, reports an action that is missing, and says
/// whether the fluid acts on it, by prepareFluid().
bool prepareStep(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept;

/// Finds its region among those of `bodies`, and rebuilds a stale model. Whether the fluid acts.
bool prepareFluid(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept;

/// The solver meets the body in a substep whose duration is not finite: Bullet must not move it.
void hold(AmbientBody& ambient, AmbientBodies& bodies) noexcept;

/// After that substep: the body goes on as it was.
void release(AmbientBody& ambient) noexcept;

/// Stops a body whose velocity is not finite, before rows carry it to others. Counts and reports
/// it.
void stopIfNotFinite(AmbientBody& ambient, Complaints& complaints) noexcept;

/// Keeps Bullet from putting a body to sleep that drifts freely: it may rest only when it moves by
/// less than a hundredth of its size within Bullet's two seconds.
void keepAwakeWhileMoving(AmbientBody& ambient) noexcept;

/// Keeps a body awake around which the fluid changes with time.
void keepAwakeInUnsteadyFluid(const AmbientBody& ambient) noexcept;

/// Flies up to kFlightsTogether bodies over `time_step` [s] and keeps where they end. Writes the
/// velocity changes in world axes that make Bullet's integrateTransform reach those poses,
/// docs/theory.md eq. (29). A flight that is not finite leaves its body adrift, and nothing is
/// kept.
void beginFlights(AmbientBody* const* bodies, int count, double time_step,
                  Twist* changes_W) noexcept;

/// After Bullet has moved the body: gives it the velocity of the end of its flight, and the pose
/// itself where Bullet limits the rotation per step.
void endFlight(AmbientBody& ambient, double time_step) noexcept;

AMBIENT_END
