#pragma once

#include <optional>

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/reading.h"

namespace ambient {

/// Data of a body or link whose wrench is read: results, and quantities of the present substep.
struct WrenchSensor {
  FluidWrench wrench;

  // Quantities of the present substep.
  RigidState start;  ///< state before the substep
  Surroundings surroundings;
  SurfacePlane plane_W;
  WaveMemory waves;
  Twist moved_W;                ///< velocity by which Bullet moves the body, world axes
  RigidState end;               ///< links only: state after the substep
  BodyModel model;              ///< model in the substep
  Wrench impulse_W;             ///< impulse of constraint rows [N m s, N s]
  bool knows_impulse = false;   ///< true: impulse_W is known; false: the balance of momentum gives
                                ///< the constraint wrench
  Wrench added_mass_impulse_W;  ///< impulse on a link by the change of its added mass [N m s, N s]
};

/// Begins a substep in a fluid, once the water surface near the body is known. `surroundings`:
/// without pushByFlow().
void beginReading(const AmbientBody& ambient, const RigidState& start,
                  const Surroundings& surroundings, WrenchSensor& sensor) noexcept;

/// A completed substep.
struct ReadStep {
  const RigidState& middle;  ///< state in the middle of the path, with the mean twist
  const RigidState& end;
  const BodyModel& model;  ///< at a water surface, if rows or joints have moved it, the frozen one
  bool has_flown;   ///< true: at a surface the buoyancy is that of the middle, not of `model`
  double duration;  ///< [s]
};
/// Computes WrenchSensor::wrench. Allocates nothing. Cost: one or two evaluations of the loads.
void finishReading(const AmbientBody& ambient, const ReadStep& step, WrenchSensor& sensor) noexcept;

// Functions for a rigid body whose wrench is read, in the order of calls in a substep. @pre
// AmbientBody::sensor is set

/// Begins the substep once the solver has met the body. With locked axes the impulse of its rows is
/// not known.
void beginBodyReading(AmbientBody& ambient, const RigidState& start,
                      const Surroundings& surroundings, bool is_locked) noexcept;

/// Reads the impulse of rows from the velocity change by them, after the solver's iterations.
/// `settled_inertia`: of RowVelocity.
void readRows(AmbientBody& ambient, const Twist& change_W,
              const std::optional<Matrix6>& settled_inertia, double time_step) noexcept;

/// Computes the wrenches after the action has set the velocity. `end`: state then; `before_W`:
/// velocity before the action.
void finishBodyReading(AmbientBody& ambient, Outcome kind, const MotionView& end,
                       const Twist& before_W, double time_step) noexcept;

/// Returns the parts that the present pose and velocity decide, in the fluid and at the surface
/// that the body has met last; those of added mass and constraints are 0.
FluidWrench wrenchNow(const AmbientBody& ambient, const MotionView& now) noexcept;

/// Returns the kinetic energy of the dry body and of the fluid that moves along, relative to the
/// ambient flow [J].
double kineticEnergyNow(const AmbientBody& ambient, const MotionView& now) noexcept;

}  // namespace ambient
