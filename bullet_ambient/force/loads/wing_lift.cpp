#include "bullet_ambient/force/loads/wing_lift.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/face_loads.h"

namespace ambient {
namespace {

LiftedPart halfOf(const LiftedPart& part) {
  return {part.added_mass / 2, part.volume / 2, part.area / 2, part.centre};
}

}  // namespace

WingLift::One::One(const Wing& wing, const BodyPart& part, double stall_lag)
    : shape(part.shape),
      half(halfOf(part.lifted), shape, stall_lag),
      halves(halvesOf(part.lifted.centre, shape.reach,
                      shape.shape.chord * shape.shape.facing.cross(shape.shape.span))),
      planform(part.lifted.area / 4),
      camber(wing.camber),
      nose(wing.nose),
      induced(shape.slope * shape.slope / (kPi * wing.aspect)),
      suction(normalForceSlope(wing.aspect)) {
  suction *= 1 - suction / (kPi * wing.aspect);
  if (nose != kRoundAtBothEnds) return;
  const double thickest = 4 / kPi * wing.thickness / wing.chord;  // of an ellipse
  tail_drag = 1.1 * thickest * thickest;
}

double WingLift::One::attachedShare(double across, double stalling,
                                    double speed_sq) const noexcept {
  const WingFlow<PlainArithmetic<double>> flow{across, stalling * across,        0,
                                               0,      speed_sq + kLeastSpeedSq, 0};
  return attachedFlow(across, flow, shape.in_double).share;
}

Vector3 WingLift::One::liftingVelocity(const Vector3& u, double stalling) const noexcept {
  const Vector3 &z = shape.shape.facing, chord = shape.shape.span.cross(z);
  const double across = z.dot(u), along = std::abs(chord.dot(u));
  const double share = attachedShare(across, stalling, u.squaredNorm());
  return share * (across - 2 * camber * along) * z;
}

Vector3 WingLift::One::sectionForce(const Vector3& u, double stalling) const noexcept {
  const Vector3 &z = shape.shape.facing, chord = shape.shape.span.cross(z);
  const double across = z.dot(u), along = chord.dot(u);
  const double speed_sq = u.squaredNorm();
  Vector3 force{0, 0, 0};
  if (!(speed_sq > 0)) return force;
  const double speed = std::sqrt(speed_sq);
  const double share = attachedShare(across, stalling, speed_sq);
  if (camber != 0) {
    const Vector3 turning = speed_sq * z - across * u;
    const double drag = induced * std::max(0.0, 4 * camber * (camber - across / speed));
    force +=
        share * along * along / speed_sq * (2 * camber * shape.slope * turning - drag * speed * u);
  }
  force -= tail_drag * std::abs(along) * along * chord;
  const double leading = nose == kRoundAtBothEnds ? std::copysign(1.0, along) : nose;
  const double ahead = std::max(leading * along, 0.0);
  if (ahead > 0) {
    constexpr double kSuction = 0.9, kOnset = 0.06;  // of eq. (161b), of (49a)
    const double sine_sq = across * across / speed_sq, onset = sine_sq / kOnset;
    const double clean = share * kSuction / (1 + onset * onset) * ahead / speed;
    force += clean * across * across * suction * leading * chord;
    force += clean * kPi * std::abs(across) * across * ahead / speed * z;
  }
  return force;
}

std::array<WingHalf, 2> halvesOf(const Vector3& centre, const Vector3& span, const Vector3& chord) {
  const Vector3 to_station = 0.5 / std::sqrt(3.0) * span;
  return {{{centre - to_station, span / 4, chord / 2}, {centre + to_station, span / 4, chord / 2}}};
}

WingLift::WingLift(const FluidBody& body, const std::vector<BodyPart>& parts, double stall_lag)
    : rest_(parts.front().lifted, parts.front().shape, stall_lag),
      rest_centre_(parts.front().lifted.centre) {
  for (std::size_t i = 1; i < parts.size(); ++i)
    wings_.emplace_back(body.wings[i - 1], parts[i], stall_lag);
  for (std::size_t i = 0; i < wings_.size(); ++i)
    for (std::size_t j = 0; j < wings_.size(); ++j)
      if (i != j) addWake(body, i, j);
}

void WingLift::addWake(const FluidBody& body, std::size_t from, std::size_t to) {
  constexpr double kAlike = 0.5, kAlong = 0.7, kNear = 1.5;  // cosines of z, of h; chords
  const Wing &one = body.wings[from], &other = body.wings[to];
  const Vector3 way = other.centre - one.centre, chord = one.span_axis.cross(one.facing);
  const double behind = chord.dot(way), distance = std::abs(behind);
  const double whole = (one.is_joined ? 2 : 1) * one.span;  // with its image
  const double aside = one.span_axis.dot(way) + (one.is_joined ? one.span / 2 : 0);
  const bool is_behind = distance > kNear * one.chord && std::abs(aside) <= whole / 2 &&
                         std::abs(one.facing.dot(other.facing)) > kAlike &&
                         std::abs(one.span_axis.dot(other.span_axis)) > kAlong;
  if (!is_behind || wings_[from].planform < wings_[to].planform) return;
  const double slope = normalForceSlope(one.aspect);
  double share = slope / (kPi * one.aspect) *
                 (1 + distance / std::sqrt(distance * distance + whole * whole / 4));
  if (one.is_joined) share /= 2;
  const double strength = wings_[from].shape.slope * wings_[from].planform;
  const double felt = wings_[to].shape.slope * wings_[to].planform;
  share = std::min(share, 2 * std::sqrt(strength / felt));
  wakes_.push_back({from, to, std::copysign(1.0, behind) * chord, share});
}

Twist WingLift::seenBy(std::size_t wing, const Twist& x, const WetPart* wet) const noexcept {
  Twist seen = x;
  for (const Wake& wake : wakes_) {
    if (wake.to != wing) continue;
    const One& one = wings_[wake.from];
    const Vector3 u = x.at(one.shape.shape.centre);
    const double ahead = -wake.behind.dot(u), speed_sq = u.squaredNorm();
    if (!(ahead > 0) || !(speed_sq > 0)) continue;
    double share = wake.share * ahead * ahead / speed_sq;
    if (wet) share *= (one.halves[0].wetShare(*wet) + one.halves[1].wetShare(*wet)) / 2;
    const double stalling = one.shape.stallingShare(x.angular, x.linear);
    seen.linear -= share * one.liftingVelocity(u, stalling);
  }
  return seen;
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

Wrench WingLift::load(const Twist& x, double density, double munk_of_rest, double munk_of_wings,
                      const WetPart* wet) const noexcept {
  const double wet_density = (wet ? wet->share : 1) * density;
  Wrench sum = rest_.load(x.angular, x.at(rest_centre_), wet_density, munk_of_rest)
                   .aboutOrigin(rest_centre_);
  for (std::size_t i = 0; i < wings_.size(); ++i) {
    const One& wing = wings_[i];
    const Twist seen = seenBy(i, x, wet);
    const double stalling = wing.shape.stallingShare(seen.angular, seen.linear);
    for (const WingHalf& half : wing.halves) {
      const double share = wet ? half.wetShare(*wet) : 1;
      sum +=
          wing.half
              .load(seen.angular, seen.at(half.station), share * density, munk_of_wings, stalling)
              .aboutOrigin(half.station);
    }
  }
  return sum;
}

// Halves that a surface cuts are not wet as their faces are: these may take less power then.
Wrench WingLift::bySection(std::size_t number, const Twist& x, double density, const WetPart* wet,
                           const Wrench& on_faces) const noexcept {
  const One& wing = wings_[number];
  Wrench sum;
  if (wing.isFlat()) return sum;
  const double stalling = wing.shape.stallingShare(x.angular, x.linear);
  for (const WingHalf& half : wing.halves) {
    const double share = wet ? half.wetShare(*wet) : 1;
    const Vector3 force = wing.sectionForce(x.at(half.station), stalling);
    sum += Wrench::ofForceAt(share * density / 2 * wing.planform * force, half.station);
  }
  const double gained = power(sum, x), taken = std::max(-power(on_faces, x), 0.0);
  return gained > taken ? taken / gained * sum : sum;
}

}  // namespace ambient
