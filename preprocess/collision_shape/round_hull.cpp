#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/collision_shape/form_body.h"

namespace ambient {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kSame =
    3e-4;  // of radius and height: Bullet rounds corners of hulls to 1e-4 of it

/// Returns the area of the polygon on a circle of radius 1 with corners at these angles; 0 if two
/// neighbours are more than a 24th of a turn apart.
double areaOnUnitCircle(std::vector<double> angles) {
  constexpr double kWidest = 1.001 * 2 * kPi / 24;
  if (angles.empty()) return 0;
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + 2 * kPi);
  double area = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const double gap = angles[i] - angles[i - 1];
    if (gap > kWidest) return 0;
    area += portable::sin(gap) / 2;
  }
  return area;
}

/// The cylinder about an axis that is parallel to axis k.
std::optional<PlacedShape> cylinderAlong(int k, const Points& points) {
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  double low = points.front()[k], high = low, radius = 0;
  Eigen::Vector3d centre(0, 0, 0);
  for (const Eigen::Vector3d& point : points) {
    low = std::min(low, point[k]);
    high = std::max(high, point[k]);
    centre += point / static_cast<double>(points.size());
  }
  centre[k] = (low + high) / 2;
  const double half = (high - low) / 2;
  for (const Eigen::Vector3d& point : points)
    radius += portable::hypot(point[i] - centre[i], point[j] - centre[j]) /
              static_cast<double>(points.size());
  std::vector<double> angles[2];
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d r = point - centre;
    if (!(std::abs(std::abs(r[k]) - half) <= kSame * half)) return std::nullopt;
    if (!(std::abs(portable::hypot(r[i], r[j]) - radius) <= kSame * radius)) return std::nullopt;
    angles[r[k] > 0].push_back(portable::atan2(r[j], r[i]));
  }
  const double area = std::min(areaOnUnitCircle(angles[0]), areaOnUnitCircle(angles[1]));
  if (!(area > 0) || !(half > 0)) return std::nullopt;
  PlacedShape part{Cylinder{radius * std::sqrt(area / kPi), 2 * half}};
  part.pose.linear() << Eigen::Vector3d::Unit(i), Eigen::Vector3d::Unit(j),
      Eigen::Vector3d::Unit(k);
  part.pose.translation() = centre;
  return part;
}

}  // namespace

ShapeForm recognised(ShapeForm form) {
  if (form.parts.size() != 1) return form;
  PlacedShape& part = form.parts.front();
  const auto* hull = std::get_if<Hull>(&part.shape);
  if (!hull || hull->points.empty()) return form;
  for (int k = 0; k < 3; ++k) {
    const std::optional<PlacedShape> cylinder = cylinderAlong(k, hull->points);
    if (!cylinder) continue;
    part.pose = part.pose * cylinder->pose;
    part.shape = cylinder->shape;
    return form;
  }
  return form;
}

}  // namespace ambient
