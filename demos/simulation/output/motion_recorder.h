#pragma once

#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Interpolates between two samples: cubic Hermite in position and rotation vector, linear in the
/// twist. For smooth motion the error of the pose is of fourth order in the interval. At either
/// end the result is the sample, bit for bit.
/// @pre from.time <= time <= to.time
MotionSample interpolateMotion(const MotionSample& from, const MotionSample& to, double time);

/// Records the motion of bodies at chosen times from samples at successive steps of a world;
/// interpolates between two steps. Successive quaternions have a positive scalar product.
class MotionRecorder {
 public:
  /// times [s]: ascending, none before the first sample; time_step [s]: step of the world
  MotionRecorder(std::vector<double> times, double time_step);

  /// Adds one sample of each body, all at the same time.
  void add(const std::vector<MotionSample>& now);

  /// Recorded samples [body][time], for all times reached so far.
  std::vector<std::vector<MotionSample>>& motion() { return motion_; }

 private:
  void record(std::size_t body, const MotionSample& now);

  std::vector<double> times_;
  double tolerance_;
  std::vector<MotionSample> last_;
  std::vector<std::vector<MotionSample>> motion_;
  std::size_t next_ = 0;
};

/// Times begin, begin + step, begin + 2 step and so on below begin + duration, and finally
/// begin + duration [s].
std::vector<double> timesOf(double begin, double duration, double step);

}  // namespace ambient
