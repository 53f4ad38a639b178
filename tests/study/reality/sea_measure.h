#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Coordinate of a body over time.
struct CoordinateSeries {
  std::vector<double> times;   ///< [s], rising
  std::vector<double> values;  ///< [m], [rad], [m/s] or [g]
};

/// Coordinate of a motion: "z" height of the centre of mass [m]; "roll" about the world's x axis
/// [rad]; "vx", "vy", "vz" velocity [m/s]; "felt" upward acceleration that a sensor on board feels,
/// over that of gravity [1].
/// @throws std::invalid_argument that names an unknown coordinate.
CoordinateSeries seriesOf(const std::string& along, const std::vector<MotionSample>& motion,
                          double gravity);

/// Number taken from a series: "measure" in data/reality/measurements_at_sea.json.
struct MotionMeasure {
  /// Number: "value" at `time`; "mean" since then; "largest"; "extreme" and "time of extreme"
  /// number `count`, the start not counted; "period" over `count` half periods; "decay" [1/s] of
  /// `count` extremes, the slope of ln |y| over time; "quadratic decay" [1/rad], kappa in dw/dt =
  /// -kappa |w| w, from the extremes `count` and `count` + 1; "amplitude" of the last `count`
  /// periods of `period`, that of a sine of the same variance.
  std::string of;
  std::string along = "z";  ///< coordinate, as seriesOf() has it
  int count = 1;
  double balance = 0;  ///< y at rest; the number is that of y - balance
  double scale = 1;    ///< divides the number, but for times and decays in time
  double period = 0;   ///< [s]
  double time = 0;     ///< [s]
};

/// @throws std::invalid_argument that names an unknown number.
MotionMeasure readMotionMeasure(const nlohmann::json& from);

/// @throws std::runtime_error if the series has too few extremes or crossings.
double measure(const MotionMeasure& what, const CoordinateSeries& series);

}  // namespace ambient
