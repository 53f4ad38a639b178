#include "demos/simulation/output/motion_recorder.h"

#include <cmath>
#include <utility>

#include "demos/simulation/output/motion_interpolation.h"

namespace ambient {
namespace {

// Relative tolerance for comparing times: multiples of a decimal step are rounded.
constexpr double kTimeRounding = 1e-9;

}  // namespace

MotionRecorder::MotionRecorder(std::vector<double> times, double time_step)
    : times_(std::move(times)), tolerance_(kTimeRounding * time_step) {}

void MotionRecorder::add(const std::vector<MotionSample>& now) {
  motion_.resize(now.size());
  while (next_ < times_.size() && times_[next_] <= now.front().time + tolerance_) {
    for (std::size_t body = 0; body < now.size(); ++body) record(body, now[body]);
    ++next_;
  }
  last_ = now;
}

void MotionRecorder::record(std::size_t body, const MotionSample& now) {
  const double time = times_[next_];
  const bool at_step = std::abs(time - now.time) <= tolerance_;
  MotionSample sample = at_step ? now : interpolateMotion(last_[body], now, time);
  sample.time = time;
  appendSample(motion_[body], sample);
}

std::vector<double> timesOf(double begin, double duration, double step) {
  std::vector<double> times;
  for (double time = 0; time < duration * (1 - kTimeRounding);
       time = static_cast<double>(times.size()) * step)
    times.push_back(begin + time);
  times.push_back(begin + duration);
  return times;
}

}  // namespace ambient
