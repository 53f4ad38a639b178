#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/reading/fluid_wrench.h"
#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

/// Kept for a body or link whose wrench is read; others have none.
struct FluidReading {
  FluidWrench wrench;

  // Quantities of the substep under way.
  RigidState start;  ///< before it
  Surroundings surroundings;
  SurfacePlane plane_W;
  WaveMemory waves;
  Twist moved_W;               ///< by which Bullet moves it
  RigidState end;              ///< of a link, after it
  BodyModel model;             ///< of a link, as the substep has it
  Wrench impulse_W;            ///< of rows [N m s, N s]
  bool knows_impulse = false;  ///< else what the balance leaves to it
  Wrench passage_W;            ///< impulse on a link by the change of its added mass [N m s, N s]
};

/// At the start of a substep in a fluid, once the place of the surface is known.
void beginReading(const AmbientBody& ambient, const RigidState& start,
                  const Surroundings& surroundings, FluidReading& reading) noexcept;

/// End of a substep.
struct ReadStep {
  const RigidState& middle;  ///< of the way, with the mean twist
  const RigidState& end;
  const BodyModel& model;  ///< frozen at a surface, if rows or joints have moved it
  bool has_flown;          ///< at a surface the model is not frozen
  double duration;         ///< [s]
};
/// Computes the wrenches. Allocates nothing. Cost: an evaluation or two of the loads.
void finishReading(const AmbientBody& ambient, const ReadStep& step,
                   FluidReading& reading) noexcept;

AMBIENT_END
