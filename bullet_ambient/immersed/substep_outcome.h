#pragma once

#include <optional>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/motion/body/kirchhoff.h"
#include "bullet_ambient/motion/body/rigid_state.h"

AMBIENT_BEGIN

/// Outcome of a substep for a body, from the solver; docs/bullet_step.md has the transitions.
enum class Outcome {
  kNotMet,  ///< the solver has not met it since the action took the last outcome
  kStock,   ///< moves as in stock Bullet: not in a fluid, static, or of no physical mass
  kRows,    ///< moved by rows
  kAdrift,  ///< moved by no row, and does not fly: locked, fast among rows, or its flight failed
  kFlown,   ///< moved by no row, and has flown
  kHeld,    ///< moved by nothing: the substep has no finite duration
};

/// Part of a motion by rows that is left to the action; docs/theory.md eq. (31).
struct RowMotion {
  RigidState start;  ///< from where Bullet moves the body; twist relative to the flow
  Vector3 flow_W = Vector3::Zero();
  bool is_held = false;  ///< by joints, or by what cannot move
  double turn = 0;       ///< that the body can make meanwhile [rad]
  /// Relative to the flow, that it keeps; none: of a body with locked axes.
  std::optional<WorldMomentum> momentum;
  /// Twice the kinetic energy that it may have in its next pose [J]; none: any.
  std::optional<double> energy_bound;
};

/// End of a free flight.
struct FlightEnd {
  RigidState state;
  Twist twist_W;
  Twist effective_W;         ///< constant twist that Bullet integrates onto the end pose
  double length_scale = 0;   ///< lengths whose rounding the end position carries [m]
  bool is_too_long = false;  ///< steps are, which has become clear in this one
};

/// Effect of a substep on one body: written by the solver, taken once by the action.
struct SubstepOutcome {
  Outcome kind = Outcome::kNotMet;
  int world_index = -1;      ///< where the body stood in its world's array when it was met
  int activation_state = 0;  ///< of kHeld: the body's own, meanwhile it is disabled
  RowMotion rows;            ///< of kRows and kAdrift
  FlightEnd flight;          ///< of kFlown
};

AMBIENT_END
