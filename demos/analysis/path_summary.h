#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Mode of a falling plate, after Andersen, Pesavento and Wang 2005; Padilla et al. 2025, sec. 5.1.
enum class FallingMode {
  kSteady,    ///< neither swings nor overturns in the second half of the fall
  kFlutter,   ///< swings; share of overturns at most kPureShare
  kTumbling,  ///< overturns; share of swings at most kPureShare
  kMixed,     ///< swings and overturns; "chaotic" in the literature
};

/// Names of the modes in summaries.
constexpr std::array<std::pair<FallingMode, const char*>, 4> kFallingModeNames{
    {{FallingMode::kSteady, "steady"},
     {FallingMode::kFlutter, "flutter"},
     {FallingMode::kTumbling, "tumbling"},
     {FallingMode::kMixed, "mixed"}}};
inline std::string fallingModeName(FallingMode mode) { return wordOf(kFallingModeNames, mode); }

/// Smallest departure from broadside for which a swing counts [rad].
constexpr double kLeastSwing = 0.17453292519943295;  // 10 degrees

/// Largest share of the rarer kind of event at which a fall still counts as flutter or tumbling.
constexpr double kPureShare = 0.05;

/// Passage through a broadside position at `time` [s], after a swing or an overturn.
struct FallEvent {
  double time = 0;
  bool is_overturn = false;
};

/// Swings and overturns of a fall. The swing axis is the horizontal axis that the plate turns about
/// most. The tilt is the angle of the normal from the vertical about the swing axis, continuous
/// over full turns. At multiples of pi the plate is broadside. A swing lies between two passages of
/// the same multiple of pi: the plate has turned back. An overturn lies between two successive
/// multiples: half a turn.
struct Fall {
  FallingMode mode = FallingMode::kSteady;
  int overturns = 0;
  int swings = 0;                 ///< number of swings of at least kLeastSwing
  double turns = 0;               ///< full turns by overturns in either direction [1]
  double largest_swing = 0;       ///< largest departure from broadside of all swings [rad]
  double descent_speed = 0;       ///< mean over the second half of the fall [m/s], > 0 downwards
  double drift_speed = 0;         ///< size of the mean horizontal velocity, second half [m/s]
  std::vector<FallEvent> events;  ///< in order of time
  Vector3 swing_axis = Vector3::Zero();  ///< horizontal unit vector; 0 if the normal never moves
};

/// Classifies the fall of a plate; `normal`: unit normal in the shape's axes; gravity in W [m/s^2].
/// @pre the samples are in order of time, the plate turns by less than half a turn between two of
/// them, and gravity is not zero
Fall analyseFall(const std::vector<MotionSample>& samples, const Vector3& normal,
                 const Vector3& gravity);

/// Summary of the path of one body's centre of mass.
struct PathSummary {
  double length = 0;                    ///< length of the path [m]
  double largest_speed = 0;             ///< [m/s]
  double largest_height = 0;            ///< above the plane through W's origin, against gravity [m]
  double descent_speed = 0;             ///< mean over all samples [m/s], > 0 downwards
  std::optional<MotionSample> landing;  ///< first passage through that plane downwards
};

/// Summarises one path; gravity in W; without gravity "up" is +z.
PathSummary summarisePath(const std::vector<MotionSample>& samples, const Vector3& gravity);

}  // namespace ambient
