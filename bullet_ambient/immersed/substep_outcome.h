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
  kAdrift,  ///< moved by no row and by no flight: locked axes, too fast a spin among rows, or a
            ///< failed flight
  kFlown,   ///< moved by no row, and has flown
  kHeld,    ///< moved by nothing: the substep has no finite duration
};

/// Data that the action needs to complete a motion by rows; docs/theory.md eq. (31).
struct RowMotion {
  RigidState start;  ///< state before Bullet moves the body; twist relative to the flow
  Vector3 flow_W = Vector3::Zero();
  bool is_held = false;  ///< true: joints, or contacts with bodies that cannot move, hold the body
  double turn = 0;       ///< largest turn of the body during the step [rad]
  /// World momentum relative to the flow, which the turn keeps; none: a body with locked axes.
  std::optional<WorldMomentum> momentum;
  /// Twice the kinetic energy allowed at the next pose [J]; none: no bound.
  std::optional<double> energy_bound;
};

/// End of a free flight.
struct FlightEnd {
  RigidState state;
  Twist twist_W;
  Twist effective_W;        ///< constant twist that Bullet integrates onto the end pose
  double length_scale = 0;  ///< size of the coordinates whose rounding the end position carries [m]
  bool is_too_long = false;  ///< true: with this step the errors exceed StepErrors::kLargest
};

/// Effect of a substep on one body: written by the solver, taken once by the action.
struct SubstepOutcome {
  Outcome kind = Outcome::kNotMet;
  int world_index = -1;      ///< index of the body in its world's array when the solver met it
  int activation_state = 0;  ///< kHeld: activation state to restore; meanwhile the body is disabled
  RowMotion rows;            ///< for kRows and kAdrift
  FlightEnd flight;          ///< for kFlown
};

AMBIENT_END
