#include "tests/preprocess/table_generator/meridian.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"

namespace ambient {
namespace {

MeridianPiece line(const MeridianPoint& begin, const MeridianPoint& end) { return {begin, end}; }

MeridianPiece arc(const MeridianPoint& begin, const MeridianPoint& end,
                  const MeridianPoint& centre) {
  return {begin, end, true, centre};
}

/// Angle from begin to end of an arc, clockwise.
double angleOf(const MeridianPiece& arc) {
  const Eigen::Vector2d from = arc.begin - arc.centre, to = arc.end - arc.centre;
  return portable::atan2(from.y() * to.x() - from.x() * to.y(), from.dot(to));
}

Eigen::Vector2d turnedBack(const Eigen::Vector2d& arm, double angle) {
  const double c = portable::cos(angle), s = portable::sin(angle);
  return {c * arm.x() + s * arm.y(), c * arm.y() - s * arm.x()};
}

}  // namespace

double MeridianPiece::length() const {
  return is_arc ? angleOf(*this) * (begin - centre).norm() : (end - begin).norm();
}

MeridianPoint MeridianPiece::at(double fraction) const {
  if (!is_arc) return begin + fraction * (end - begin);
  return centre + turnedBack(begin - centre, fraction * angleOf(*this));
}

Eigen::Vector2d MeridianPiece::normalAt(double fraction) const {
  if (is_arc) return (at(fraction) - centre).normalized();
  const Eigen::Vector2d along = (end - begin).normalized();
  return {-along.y(), along.x()};
}

Meridian cylinderMeridian(double radius, double height) {
  const MeridianPoint top{radius, height / 2}, bottom{radius, -height / 2};
  return {line({0, height / 2}, top), line(top, bottom), line(bottom, {0, -height / 2})};
}

Meridian capsuleMeridian(double radius, double height) {
  const MeridianPoint top{radius, height / 2}, bottom{radius, -height / 2};
  return {arc({0, height / 2 + radius}, top, {0, height / 2}), line(top, bottom),
          arc(bottom, {0, -height / 2 - radius}, {0, -height / 2})};
}

Meridian coneMeridian(double radius, double height, double rounding) {
  const MeridianPoint apex{0, height / 2}, rim{radius, -height / 2}, middle{0, -height / 2};
  if (rounding == 0) return {line(apex, rim), line(rim, middle)};
  const Eigen::Vector2d out = rounding * Eigen::Vector2d(height, radius).normalized(),
                        down{0, -rounding};
  return {arc(apex - down, apex + out, apex), line(apex + out, rim + out),
          arc(rim + out, rim + down, rim), line(rim + down, middle + down)};
}

}  // namespace ambient
