#pragma once

#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// How a plate falls, after Andersen, Pesavento and Wang 2005 and Padilla et al. 2025, section 5.1.
enum class FallingMode {
  kSteady,    ///< nothing happens in the second half of the fall
  kFlutter,   ///< it swings to and fro and does not overturn
  kTumbling,  ///< it overturns all the time
  kMixed,     ///< both; "chaotic" in the literature
};

/// "steady", "flutter", "tumbling" or "mixed".
std::string fallingModeName(FallingMode mode);

/// Least angle that a plate departs from broadside for a swing to count [rad].
constexpr double kLeastSwing = 0.17453292519943295;  // 10 degrees

/// Share of the rarer kind of event up to which a fall still counts as the pure mode.
constexpr double kPureShare = 0.05;

/// A plate passes its broadside position at `time` [s], having swung or overturned since the last.
struct FallEvent {
  double time = 0;
  bool is_overturn = false;
};

/// What one fall consists of. The tilt of the plate is the angle of its normal about the swing
/// axis, the horizontal axis that it turns about most, counted on through full turns; at a multiple
/// of pi the plate is broadside to the vertical. Between one broadside position and the next lies
/// either a swing (the same multiple: the plate has turned back) or an overturn (the next multiple:
/// it has made half a turn).
struct Fall {
  FallingMode mode = FallingMode::kSteady;
  int overturns = 0;
  int swings = 0;                 ///< of at least kLeastSwing
  double turns = 0;               ///< full turns made by overturning, whichever way [1]
  double largest_swing = 0;       ///< largest departure from broadside of all swings [rad]
  double descent_speed = 0;       ///< mean over the second half of the fall [m/s], > 0 downwards
  double drift_speed = 0;         ///< horizontal, mean over the second half of the fall [m/s]
  std::vector<FallEvent> events;  ///< in order of time
  Vector3 swing_axis = Vector3::Zero();  ///< horizontal unit vector; 0 if the normal never moves
};

/// Classifies the fall of a plate with the unit normal `normal` (shape's axes) in gravity.
/// @pre the samples are in order of time, the plate turns by less than half a turn between two of
/// them, and gravity is not zero
Fall analyseFall(const std::vector<MotionSample>& samples, const Vector3& normal,
                 const Vector3& gravity);

}  // namespace ambient
