#include "bullet_ambient/force/law/form_law.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

namespace {

template <class Number>
WingFactors<Number> wingFactorsOf(const ShapeFactors& of) {
  WingFactors<Number> factors;
  const FormShape& shape = of.shape;
  const double sigma = of.stall_sine;
  constexpr double kLeastWing = 1e-12;  // of W: keeps the inverse of k finite
  const double root = std::sqrt(std::max(shape.wing, kLeastWing));
  const double stall = std::sqrt(root) / (4 * sigma * sigma);
  factors.is_wing = shape.isWing();
  factors.is_slender = shape.isSlender();
  factors.is_part = !of.reach.isZero(0);
  const double more = of.slope - of.slope_along;
  const bool is_along = !(more < 0);  // K|y|^2 + (K' - K)(h.u)^2 = K'|y|^2 - (K' - K)(h x z.u)^2
  const Vector3 axis = is_along ? shape.span : Vector3(shape.facing.cross(shape.span));
  const Vector3 span = std::sqrt(std::abs(more) / stall) * axis;
  factors.wing_root = static_cast<Number>(root);
  factors.stall = static_cast<Number>(stall);
  factors.slope = static_cast<Number>((is_along ? of.slope : of.slope_along) / stall);
  for (int axis = 0; axis < 3; ++axis) {
    factors.facing[axis] = static_cast<Number>(shape.facing[axis]);
    factors.span[axis] = static_cast<Number>(span[axis]);
    factors.slender[axis] = static_cast<Number>(shape.slender[axis]);
  }
  return factors;
}

FormShape formShapeOf(const Wing& wing, double share) {
  FormShape shape;
  shape.wing = share;
  shape.aspect = wing.aspect;
  shape.chord = wing.chord;
  shape.facing = wing.facing;
  shape.span = wing.span_axis;
  shape.centre = wing.centre;
  constexpr double kPitchRelief = 0.4;  // of eq. (43d)
  const double strip = 1 - 1 / (wing.aspect * wing.aspect);
  shape.pitching = std::sqrt(kPitchRelief * std::max(0.0, strip)) * wing.span_axis;
  return shape;
}

/// How much later the flow around a thick round nose separates than around an edge, eq. (161b).
double lateStallOf(const Wing& wing) {
  constexpr double kThickest = 1.3;  // thickness of a section over its mean
  return wing.nose == 0 ? 0 : 0.6 * std::min(kThickest * wing.thickness / wing.chord, 0.12);
}

}  // namespace

double normalForceSlope(double aspect) {
  return 2 * kPi * aspect / (2 + std::sqrt(4 + aspect * aspect));
}

double stallSine(double aspect) {
  constexpr double kLong = 0.18;                   // fitted on Eiffel's plates of 1, 2 and 6 to 1
  constexpr double kSquare = 0.70710678118654752;  // sine of 45 degrees: none is left broadside
  return kLong + (kSquare - kLong) / (aspect * std::sqrt(aspect));
}

ShapeFactors::ShapeFactors(const FormShape& form_shape)
    : shape(form_shape),
      slope(normalForceSlope(shape.aspect)),
      slope_along(normalForceSlope(1 / shape.aspect)),
      stall_sine(stallSine(shape.aspect)),
      in_single(wingFactorsOf<float>(*this)),
      in_double(wingFactorsOf<double>(*this)) {
  AMBIENT_ASSERT(shape.aspect >= 1);
}

ShapeFactors::ShapeFactors(const Wing& wing, double share)
    : shape(formShapeOf(wing, share)),
      slope(wing.body_lift * normalForceSlope(wing.aspect)),
      slope_along(normalForceSlope(1 / wing.aspect)),
      stall_sine(stallSine(std::max(wing.aspect, 1.0)) + lateStallOf(wing)),
      root(wing.centre - wing.span / 2 * wing.span_axis),
      reach(wing.span * wing.span_axis),
      in_single(wingFactorsOf<float>(*this)),
      in_double(wingFactorsOf<double>(*this)) {
  AMBIENT_ASSERT(wing.aspect > 0 && wing.span > 0);
}

double ShapeFactors::stallingShare(const Vector3& w, const Vector3& v, double length) const {
  const double turning = w.cross(reach / length).squaredNorm();
  const double moving = (v + w.cross(root / length)).squaredNorm();
  return turning > 0 ? moving / (turning + moving) : 1;
}

double ShapeFactors::wakeShare() const {
  constexpr double kSharp = 0.9;  // edges from which on a body sheds at once
  return std::max(0.0, 1 - shape.edges / kSharp);
}

namespace {

constexpr double kStallIncidence = 0.45;  // scale of xi in eq. (49)
constexpr double kOnset = 0.06;   // epsilon of eq. (49a): sin^2 of the incidence of 14 degrees
constexpr double kLargest = 1e8;  // of a ratio; beyond, the share is 0 or 1

/// 1 - f of eq. (49); xi: lagged sin^2 of the incidence, eq. (48).
double separatedShareOfBlocks(double xi) noexcept {
  const double z = std::clamp(xi / kStallIncidence - 0.25, -kLargest, kLargest);
  return 0.5 * (1 + z / std::sqrt(1 + z * z));
}

/// x^2 / (1 + x^2), from 0 to 1 as |x| grows.
double saturated(double x) noexcept {
  const double square = std::min(x * x, kLargest * kLargest);
  return square / (1 + square);
}

}  // namespace

FormLift::FormLift(const LiftedPart& body, const ShapeFactors& factors, double stall_lag)
    : wing_(factors.shape.wing) {
  AMBIENT_ASSERT(stall_lag >= 0);
  AMBIENT_ASSERT(body.volume >= 0 && body.area >= 0);
  const SymmetricEigen<3> eigen = symmetricEigen<3>(body.added_mass);
  const Eigen::Vector3d& k = eigen.values;
  const Matrix3& axes = eigen.vectors;
  largest_ = k[2] - k[0];
  if (largest_ > 0 && body.area > 0) {
    const Vector3 relative(0, (k[1] - k[0]) / largest_, 1);
    direction_ = axes * relative.asDiagonal() * axes.transpose();
    delay_ = 2 * stall_lag * 8 * largest_ / (kPi * body.area);
    if (factors.shape.isWing()) {
      const double length = 8 * largest_ / (kPi * body.area);
      attached_ = std::min(1.0, factors.slope * factors.shape.chord / (2 * kPi * length));
      stall_sq_ = factors.stall_sine * factors.stall_sine;
    }
  }
  const Vector3 differences(k[2] - k[1], k[2] - k[0], k[1] - k[0]);
  const double lifting =
      (1 - factors.shape.slender.squaredNorm()) * (1 - wing_ * (1 - attached_) / 2);
  circulation_ = body.volume / 2 * Matrix3::Identity() +
                 lifting * (axes * differences.asDiagonal() * axes.transpose());
}

Wrench FormLift::load(const Vector3& w, const Vector3& v, double density, double munk_factor,
                      double stalling) const noexcept {
  AMBIENT_ASSERT(density >= 0);
  Wrench about_centre{Vector3::Zero(), (circulation_ * w).cross(v)};
  addStall(w, v, munk_factor, stalling, about_centre);
  return density * about_centre;
}

double FormLift::separatedShare(double phi, double turning) const noexcept {
  const double of_blocks = separatedShareOfBlocks(phi - turning);
  if (!(wing_ > 0)) return of_blocks;
  const double xi = phi - turning * phi / (phi + kOnset);
  const double of_wings = xi > 0 ? 1 - attached_ * (1 - saturated(xi / stall_sq_))
                                 : (1 - attached_) * (1 - saturated(xi / kOnset));
  return wing_ * of_wings + (1 - wing_) * of_blocks;
}

void FormLift::addStall(const Vector3& w, const Vector3& v, double munk_factor, double stalling,
                        Wrench& about_centre) const noexcept {
  const double speed = v.norm();
  if (!(largest_ > 0) || !(speed > 0)) return;
  const Vector3 e = v / speed;
  const Vector3 across = direction_ * e;
  const Vector3 munk = across.cross(e);
  const double turning = stalling * delay_ * (w.dot(munk) / speed);
  const double lost = munk_factor * separatedShare(e.dot(across), turning) * largest_ * speed;
  about_centre.torque -= lost * speed * munk;
  about_centre.force -= lost * across.cross(w);
}

}  // namespace ambient
