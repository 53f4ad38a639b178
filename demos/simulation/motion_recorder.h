#pragma once

#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// The motion of bodies at chosen times, from samples at successive steps of a world: interpolated
/// where a time lies between two steps. Quaternions keep the sign of the one before.
class MotionRecorder {
 public:
  /// @param times in rising order, none before the first sample [s]
  MotionRecorder(std::vector<double> times, double time_step);

  /// One sample of each body, all of one time.
  void add(const std::vector<MotionSample>& now);

  /// Per body, one sample per time that was reached.
  std::vector<std::vector<MotionSample>>& motion() { return motion_; }

 private:
  void record(std::size_t body, const MotionSample& now);

  std::vector<double> times_;
  double tolerance_;
  std::vector<MotionSample> last_;
  std::vector<std::vector<MotionSample>> motion_;
  std::size_t next_ = 0;
};

/// Multiples of `step` after `begin`, which comes first, up to `begin` + `duration`, which comes
/// last [s].
std::vector<double> timesOf(double begin, double duration, double step);

}  // namespace ambient
