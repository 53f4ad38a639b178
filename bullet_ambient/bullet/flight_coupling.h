#pragma once

#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Whether the fluid acts on the body in this step. Rebuilds a stale model, and reports an action
/// that is missing.
bool prepareStep(AmbientRegistry& registry, AmbientBody& ambient) noexcept;

/// Stops a body whose velocity is not finite, before rows carry it to others. Counts and reports
/// it; returns whether it did.
bool stopIfNotFinite(AmbientRegistry& registry, AmbientBody& ambient) noexcept;

/// Flies up to kFlightsTogether bodies over `time_step` [s] and keeps where they end. Writes the
/// velocity changes in world axes that make Bullet's integrateTransform reach those poses,
/// docs/theory.md eq. (29). If a flight is not finite, its has_flown is false and nothing is kept.
void beginFlights(AmbientBody* const* bodies, int count, double time_step,
                  Twist* changes_W) noexcept;

/// After Bullet has moved the body: gives it the velocity of the end of its flight, and the pose
/// itself where Bullet limits the rotation per step.
void endFlight(AmbientBody& ambient, double time_step) noexcept;

/// For a body that rows have moved to `solved_W` while it turns fast: bounds the kinetic energy
/// that it may have in its next pose, docs/theory.md eq. (31).
void boundEnergy(AmbientBody& ambient, const Twist& solved_W) noexcept;

/// After Bullet has moved the body: scales its velocity relative to the fluid down to that energy.
void limitEnergy(AmbientBody& ambient) noexcept;

/// Keeps Bullet from putting a body to sleep that drifts freely: it may rest only when it moves by
/// less than a hundredth of its size within Bullet's two seconds.
void keepAwakeWhileMoving(const AmbientBody& ambient) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
