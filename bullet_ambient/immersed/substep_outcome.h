#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/motion/body/rigid_state.h"
#include "bullet_ambient/motion/flight/flight_memory.h"

AMBIENT_BEGIN

/// Outcome of a substep for a body, from the solver; docs/bullet_step.md has the transitions.
enum class Outcome : std::uint8_t {
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
  Quaternion orientation = Quaternion::Identity();  ///< B to W, before Bullet moves the body
  Vector3 position = Vector3::Zero();               ///< of the centre of mass before that, with the
                                                    ///< position correction of the rows [m]
  Twist velocity_W;                                 ///< xi: Bullet moves it by xi and the flow
  Vector3 flow_W = Vector3::Zero();
  bool is_held = false;  ///< true: joints, or contacts with bodies that cannot move, hold the body
  double turn = 0;       ///< largest turn of the body during the step [rad]
  /// Momentum relative to the flow, about the centre of mass at the start, which the turn keeps;
  /// none: a body with locked axes.
  std::optional<Momentum> momentum_W;
  /// Twice the kinetic energy allowed at the next pose [J]; none: no bound.
  std::optional<double> energy_bound;
};

/// Last free flight of a body: what the next one starts from, and what the action needs to complete
/// the present one.
struct LastFlight {
  Twist left_W;       ///< velocity of the body at the end, world axes
  Twist effective_W;  ///< constant twist that Bullet integrates onto the end pose
  FlightMemory memory;
  Quaternion orientation;  ///< end pose, see RigidState
  Vector3 position;
};

/// Effect of a substep on one body: written by the solver, taken once by the action.
struct SubstepOutcome {
  Outcome kind = Outcome::kNotMet;
  bool is_too_long = false;  ///< true: with this flight the errors exceed StepErrors::kLargest
  int world_index = -1;      ///< index of the body in its world's array when the solver met it
  int activation_state = 0;  ///< kHeld: activation state to restore; meanwhile the body is disabled
  /// RowMotion: since rows have moved the body, for kRows and kAdrift. It takes the place of the
  /// memory of the last flight, which is of no use then.
  std::variant<LastFlight, RowMotion> motion;

  RowMotion& rows() { return std::get<RowMotion>(motion); }
  const LastFlight& flight() const { return std::get<LastFlight>(motion); }
  /// The last flight; after a motion by rows, a new one without memory.
  LastFlight& flight() {
    if (auto* last = std::get_if<LastFlight>(&motion)) return *last;
    return motion.emplace<LastFlight>();
  }
};

/// Accumulated error E of a body's steps, as of a random walk that forgets old steps:
///
///   E^2 <- (1 - 1/n) E^2 + e^2
///
///   e  error of the velocity in a step, relative to the motion; 0 where it is within the tolerance
///   n  steps that count
class StepErrors {
 public:
  /// Limit of E above which the motion is visibly wrong. A box in water that chatters at 1/60 s has
  /// 0.06, and its path is off by 4 % after 3 s; a winged seed has 0.036 and is off by 0.6 %.
  static constexpr double kLargest = 0.05;

  /// Adds the error of a step. Returns true once: for the first step after which E exceeds
  /// kLargest.
  bool add(double error) noexcept {
    squares_ += error * error - squares_ / kSteps;
    if (was_large_ || !(squares_ > kLargest * kLargest)) return false;
    return was_large_ = true;
  }

 private:
  static constexpr double kSteps = 64;

  double squares_ = 0;  // E^2
  bool was_large_ = false;
};

AMBIENT_END
