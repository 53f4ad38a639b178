#include "demos/analysis/path_summary.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

namespace {

std::vector<Vector3> worldNormals(const std::vector<MotionSample>& samples, const Vector3& normal) {
  std::vector<Vector3> normals;
  normals.reserve(samples.size());
  for (const MotionSample& sample : samples)
    normals.push_back(sample.orientation.toRotationMatrix() * normal);
  return normals;
}

/// Horizontal direction along which the mean square of the turning steps of the normal is
/// largest; 0 if the normal rests.
Vector3 findSwingAxis(const std::vector<Vector3>& normals, const Vector3& up) {
  Matrix3 sum = Matrix3::Zero();
  const Matrix3 horizontal = Matrix3::Identity() - up * up.transpose();
  for (std::size_t i = 1; i < normals.size(); ++i) {
    const Vector3 turn = horizontal * normals[i - 1].cross(normals[i]);
    sum += turn * turn.transpose();
  }
  // Rounding alone turns a resting normal by less than this per sample [rad].
  constexpr double kResting = 1e-12;
  if (sum.trace() <= kResting * kResting * static_cast<double>(normals.size()))
    return Vector3::Zero();
  return Vector3(horizontal * symmetricEigen<3>(sum).vectors.col(2)).normalized();
}

/// Angle between the normal and the vertical about the swing axis, continuous in time [rad].
std::vector<double> computeTilt(const std::vector<Vector3>& normals, const Vector3& up,
                                const Vector3& axis) {
  const Vector3 side = axis.cross(up);
  std::vector<double> tilt;
  tilt.reserve(normals.size());
  for (const Vector3& normal : normals) {
    const double wrapped = portable::atan2(normal.dot(side), normal.dot(up));
    const double previous = tilt.empty() ? wrapped : tilt.back();
    tilt.push_back(wrapped + 2 * kPi * std::round((previous - wrapped) / (2 * kPi)));
  }
  return tilt;
}

/// Finds swings and overturns in the tilt, sample by sample.
class EventFinder {
 public:
  explicit EventFinder(Fall& fall) : fall_(fall) {}

  /// Adds one step of the tilt, from `before` to `after` in half turns; time [s].
  void step(double before, double after, double time) {
    int cell = static_cast<int>(std::floor(before));
    const int last_cell = static_cast<int>(std::floor(after));
    while (cell < last_cell) passBroadside(++cell, time);
    while (cell > last_cell) passBroadside(cell--, time);
    departure_ = std::max(departure_, std::abs(after - position_) * kPi);
  }

 private:
  void passBroadside(int position, double time) {
    const bool first = !seen_;
    const bool is_overturn = position != position_;
    const double departure = departure_;
    seen_ = true;
    position_ = position;
    departure_ = 0;
    if (first || (!is_overturn && departure < kLeastSwing)) return;
    fall_.events.push_back({time, is_overturn});
    ++(is_overturn ? fall_.overturns : fall_.swings);
    if (!is_overturn) fall_.largest_swing = std::max(fall_.largest_swing, departure);
  }

  Fall& fall_;
  bool seen_ = false;
  int position_ = 0;      // multiple of half a turn last passed
  double departure_ = 0;  // largest departure since that passage [rad]
};

FallingMode classify(const Fall& fall, double middle) {
  if (fall.events.empty() || fall.events.back().time < middle) return FallingMode::kSteady;
  const double share = static_cast<double>(fall.overturns) / (fall.overturns + fall.swings);
  if (share <= kPureShare) return FallingMode::kFlutter;
  if (share >= 1 - kPureShare) return FallingMode::kTumbling;
  return FallingMode::kMixed;
}

/// Mean velocity over the second half of the samples [m/s].
Vector3 settledVelocity(const std::vector<MotionSample>& samples) {
  const MotionSample& from = samples[samples.size() / 2];
  const MotionSample& to = samples.back();
  if (to.time <= from.time) return Vector3::Zero();
  return (to.position - from.position) / (to.time - from.time);
}

}  // namespace

Fall analyseFall(const std::vector<MotionSample>& samples, const Vector3& normal,
                 const Vector3& gravity) {
  AMBIENT_ASSERT(gravity.norm() > 0);
  Fall fall;
  if (samples.size() < 2) return fall;
  const Vector3 up = -gravity.normalized();
  const Vector3 velocity = settledVelocity(samples);
  fall.descent_speed = -velocity.dot(up);
  fall.drift_speed = (velocity - up * velocity.dot(up)).norm();
  const std::vector<Vector3> normals = worldNormals(samples, normal);
  fall.swing_axis = findSwingAxis(normals, up);
  if (fall.swing_axis.isZero()) return fall;
  const std::vector<double> tilt = computeTilt(normals, up, fall.swing_axis);
  EventFinder finder(fall);
  for (std::size_t i = 1; i < tilt.size(); ++i)
    finder.step(tilt[i - 1] / kPi, tilt[i] / kPi, samples[i].time);
  fall.turns = 0.5 * fall.overturns;
  fall.mode = classify(fall, 0.5 * (samples.front().time + samples.back().time));
  return fall;
}

namespace {

/// Interpolates the sample at height 0 between one above and one below.
MotionSample landingBetween(const MotionSample& above, const MotionSample& below,
                            const Vector3& up) {
  const double from = above.position.dot(up);
  const double share = from / (from - below.position.dot(up));
  MotionSample landing = above;
  landing.time += share * (below.time - above.time);
  landing.position += share * (below.position - above.position);
  landing.orientation =
      above.orientation *
      rotationFromVector(share * rotationVector(above.orientation.conjugate() * below.orientation));
  landing.twist.linear += share * (below.twist.linear - above.twist.linear);
  landing.twist.angular += share * (below.twist.angular - above.twist.angular);
  return landing;
}

}  // namespace

PathSummary summarisePath(const std::vector<MotionSample>& samples, const Vector3& gravity) {
  PathSummary path;
  if (samples.empty()) return path;
  const Vector3 up = gravity.isZero() ? Vector3(Vector3::UnitZ()) : Vector3(-gravity.normalized());
  path.largest_height = samples.front().position.dot(up);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double height = samples[i].position.dot(up);
    path.largest_speed = std::max(path.largest_speed, samples[i].twist.linear.norm());
    path.largest_height = std::max(path.largest_height, height);
    if (i == 0) continue;
    path.length += (samples[i].position - samples[i - 1].position).norm();
    if (!path.landing && samples[i - 1].position.dot(up) > 0 && height <= 0)
      path.landing = landingBetween(samples[i - 1], samples[i], up);
  }
  const double time = samples.back().time - samples.front().time;
  if (time > 0)
    path.descent_speed = (samples.front().position - samples.back().position).dot(up) / time;
  return path;
}

}  // namespace ambient
