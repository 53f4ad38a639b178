#include "bullet_ambient/force/loads/wing_lift.h"

#include <cmath>

#include "bullet_ambient/force/law/share_in_pool.h"

namespace ambient {
namespace {

LiftedPart halfOf(const LiftedPart& part) {
  return {part.added_mass / 2, part.volume / 2, part.area / 2, part.centre};
}

/// Moves a wrench about a point to F's origin.
Wrench aboutOrigin(const Wrench& about, const Vector3& point) {
  return {about.torque + point.cross(about.force), about.force};
}

}  // namespace

std::array<WingHalf, 2> halvesOf(const Vector3& centre, const Vector3& span, const Vector3& chord) {
  const Vector3 to_station = 0.5 / std::sqrt(3.0) * span;
  return {{{centre - to_station, span / 4, chord / 2}, {centre + to_station, span / 4, chord / 2}}};
}

WingLift::WingLift(const std::vector<BodyPart>& parts, double stall_lag)
    : rest_(parts.front().lifted, parts.front().shape, stall_lag),
      rest_centre_(parts.front().lifted.centre) {
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const BodyPart& wing = parts[i];
    const FormShape& shape = wing.shape.shape;
    const Vector3 chord = shape.chord * shape.facing.cross(shape.span);
    wings_.push_back({FormLift(halfOf(wing.lifted), wing.shape, stall_lag),
                      halvesOf(wing.lifted.centre, wing.shape.reach, chord)});
  }
}

double WingHalf::wetShare(const WetPart& wet) const noexcept {
  const SurfacePlane& plane = wet.plane;
  const double reach = std::abs(plane.normal.dot(span)) + std::abs(plane.normal.dot(chord));
  const double depth = plane.depth(station);
  double share = depth > 0 ? 1 : 0;
  if (reach > std::abs(depth)) share = 0.5 + 0.5 * depth / reach;
  if (!plane.sides_F) return share;
  const double radius_sq = chord.squaredNorm() + span.squaredNorm();
  return share * shareInPool(*plane.sides_F, station, plane.normal, radius_sq);
}

Wrench WingLift::load(const Twist& x, double density, const MunkFactors& munk,
                      const WetPart* wet) const noexcept {
  const double wet_density = (wet ? wet->share : 1) * density;
  Wrench sum =
      aboutOrigin(rest_.load(x.angular, x.at(rest_centre_), wet_density, munk.rest), rest_centre_);
  for (const One& wing : wings_)
    for (const WingHalf& half : wing.halves) {
      const double share = wet ? half.wetShare(*wet) : 1;
      const Wrench load =
          wing.half.load(x.angular, x.at(half.station), share * density, munk.wings);
      sum += aboutOrigin(load, half.station);
    }
  return sum;
}

}  // namespace ambient
