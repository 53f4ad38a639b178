#include "demos/simulation/output/motion_recorder.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
namespace {

// Relative tolerance for comparing times: multiples of a decimal step are rounded.
constexpr double kTimeRounding = 1e-9;

/// Values and slopes by s at both ends of an interval, s in [0, 1].
struct HermiteEnds {
  Vector3 value_0, slope_0, value_1, slope_1;
};

Vector3 hermite(const HermiteEnds& ends, double s) {
  const double t = 1 - s;
  return (1 + 2 * s) * t * t * ends.value_0 + s * t * t * ends.slope_0 +
         s * s * (3 - 2 * s) * ends.value_1 - s * s * t * ends.slope_1;
}

/// Adds full turns to a rotation vector so that it is as near to `guess` as possible [rad].
Vector3 nearestTurns(const Vector3& vector, const Vector3& guess) {
  const double angle = vector.norm();
  if (angle == 0) return vector;
  const Vector3 axis = vector / angle;
  return (angle + 2 * kPi * std::round((guess.dot(axis) - angle) / (2 * kPi))) * axis;
}

/// Rate of the rotation vector phi for the angular velocity `w` in the turned axes:
/// phi' = w + phi x w / 2 + (1/phi^2 - cot(phi/2) / (2 phi)) phi x (phi x w).
Vector3 vectorRate(const Vector3& vector, const Vector3& w) {
  const double angle = vector.norm();
  constexpr double kSeriesBelow = 1e-2;  // largest angle of the series, error 1e-17
  const double c = angle < kSeriesBelow
                       ? 1.0 / 12 + angle * angle / 720 + portable::pow(angle, 4) / 30240
                       : 1 / (angle * angle) - 1 / (2 * angle * portable::tan(angle / 2));
  const Matrix3 cross = crossMatrix(vector);
  return w + 0.5 * cross * w + c * cross * (cross * w);
}

}  // namespace

MotionSample interpolateMotion(const MotionSample& from, const MotionSample& to, double time) {
  if (time <= from.time) return from;
  if (time >= to.time) return to;
  const double h = to.time - from.time;
  const double s = (time - from.time) / h;
  MotionSample between;
  between.time = time;
  between.position =
      hermite({from.position, h * from.twist.linear, to.position, h * to.twist.linear}, s);
  between.twist.linear = from.twist.linear + s * (to.twist.linear - from.twist.linear);
  between.twist.angular = from.twist.angular + s * (to.twist.angular - from.twist.angular);

  // Angular velocities in the axes of the body, which are the turned axes, per unit of s.
  const Vector3 w_0 = h * (from.orientation.conjugate() * from.twist.angular);
  const Vector3 w_1 = h * (to.orientation.conjugate() * to.twist.angular);
  const Vector3 vector = nearestTurns(rotationVector(from.orientation.conjugate() * to.orientation),
                                      0.5 * (w_0 + w_1));
  // The rate is singular near a full turn: rotations beyond half a turn are interpolated linearly.
  const Vector3 turned = vector.norm() > kPi
                             ? Vector3(s * vector)
                             : hermite({Vector3::Zero(), w_0, vector, vectorRate(vector, w_1)}, s);
  between.orientation = (from.orientation * rotationFromVector(turned)).normalized();
  return between;
}

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
