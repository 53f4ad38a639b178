#include "demos/analysis/path_summary.h"

#include <algorithm>

#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
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
