#include "bullet_ambient/force/surface/wetted_inertia.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

namespace {

/// Rise of the water around an entering body [m], docs/theory.md eq. (65), and its derivative by
/// the height of the plane [1].
struct PileUp {
  double rise = 0, slope = 0;

  explicit PileUp(const Immersion& at) {
    constexpr double kPileUp = 0.4;
    if (!(at.draught() < at.size())) return;
    const double wet = at.draught() / at.size(), dry = 1 - wet;
    const double dry7 = dry * dry * dry * (dry * dry) * (dry * dry);
    rise = kPileUp * dry7 * dry * at.draught();
    slope = kPileUp * dry7 * (dry - 8 * wet);
  }
};

Immersion raised(const Immersion& immersion, const PileUp& pile_up) {
  Immersion result = immersion;
  result.plane.height += pile_up.rise;
  return result;
}

}  // namespace

double wetShare(const Immersion& immersion, double volume) noexcept {
  AMBIENT_ASSERT(volume >= 0 && !(immersion.low > immersion.high));
  const double share =
      volume > 0 ? immersion.wet.volume / volume : immersion.draught() / immersion.size();
  return std::clamp(share, 0.0, 1.0);
}

Matrix6 WettedInertia::inertia(const Immersion& immersion) const noexcept {
  AMBIENT_ASSERT(isUnit(immersion.plane.normal));
  AMBIENT_ASSERT(isSymmetric(deep_, 1e-6));
  if (immersion.isDry()) return Matrix6::Zero();
  return immersion.isDeep() ? deep_ : inertiaAt(raised(immersion, PileUp(immersion)));
}

Matrix6 WettedInertia::unraisedInertia(const Immersion& immersion) const noexcept {
  if (immersion.isDry()) return Matrix6::Zero();
  return immersion.isDeep() ? deep_ : inertiaAt(immersion);
}

InertiaGradient WettedInertia::gradient(const Immersion& immersion,
                                        const Twist& twist) const noexcept {
  if (immersion.isDry() || immersion.isDeep()) return {};
  const PileUp pile_up(immersion);
  InertiaGradient gradient = gradientAt(raised(immersion, pile_up), twist);
  if (pile_up.slope == 0 || !(immersion.wet.volume > 0)) return gradient;
  // The rise depends on the lowest point, taken to lie along s below the centre of buoyancy.
  const double by_rise = pile_up.slope * gradient.by_height;
  gradient.by_height += by_rise;
  gradient.by_normal -= by_rise * (immersion.wet.moment / immersion.wet.volume);
  return gradient;
}

namespace {

// Added mass by boundary elements with the negative image; unit: radius; scaled to pi/3 at depth 1.
constexpr double kDepths[] = {0.02, 0.07, 0.10, 0.20, 0.30, 0.40, 0.60, 0.80, 0.90,
                              1.00, 1.20, 1.40, 1.60, 1.80, 2.00, 2.20, 2.70, 4.00};
constexpr double kAlong[] = {0.0097, 0.0581, 0.0943, 0.2343, 0.3850, 0.5262,
                             0.7650, 0.9410, 1.0015, 1.0472, 1.1049, 1.1400,
                             1.1897, 1.2917, 1.4922, 1.7062, 1.9546, 2.0804};
constexpr double kAcross[] = {0.0001, 0.0012, 0.0027, 0.0149, 0.0395, 0.0772,
                              0.1924, 0.3612, 0.4655, 0.5759, 0.8210, 1.0821,
                              1.3449, 1.5836, 1.7738, 1.8966, 2.0284, 2.0921};
constexpr int kNodes = std::size(kDepths);
constexpr double kFree = 2 * kPi / 3;  // added mass in unbounded fluid
constexpr double kDeep = 6;            // depth from which on the surface is ignored

struct Value {
  double value, slope;
};

/// Interpolates by monotone cubics over the root of the depth (Fritsch and Carlson 1980). Above the
/// first node: a power of the depth, 3/2 along the normal, as for the disc that first gets wet.
class Column {
 public:
  Column(const double (&values)[kNodes], double power) : values_(values), power_(power) {
    for (int i = 0; i < kNodes; ++i) nodes_[i] = std::sqrt(kDepths[i]);
    slopes_[0] = 2 * power * values[0] / nodes_[0];
    for (int i = 1; i + 1 < kNodes; ++i) slopes_[i] = slopeAt(i);
    slopes_[kNodes - 1] = 2 * nodes_[kNodes - 1] * atDepth(kDepths[kNodes - 1]).slope;
  }

  Value at(double depth) const {
    if (depth >= kDepths[kNodes - 1]) return atDepth(depth);
    if (depth <= kDepths[0]) return atTouch(depth);
    const double x = std::sqrt(depth);
    const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, x);
    const auto i = static_cast<int>(next - nodes_.begin()) - 1;
    const double h = nodes_[i + 1] - nodes_[i], t = (x - nodes_[i]) / h;
    const double rise = values_[i + 1] - values_[i];
    const double a = h * slopes_[i] - rise, b = rise - h * slopes_[i + 1];
    const double value = values_[i] + t * (rise + (1 - t) * (a * (1 - t) + b * t));
    const double slope = (rise + (1 - 2 * t) * (a * (1 - t) + b * t) + t * (1 - t) * (b - a)) / h;
    return {value, slope / (2 * x)};
  }

 private:
  double secant(int i) const { return (values_[i + 1] - values_[i]) / (nodes_[i + 1] - nodes_[i]); }
  double slopeAt(int i) const {
    const double before = nodes_[i] - nodes_[i - 1], after = nodes_[i + 1] - nodes_[i];
    const double w = 2 * after + before, v = after + 2 * before;
    return (w + v) / (w / secant(i - 1) + v / secant(i));
  }
  Value atTouch(double depth) const {
    const double part = portable::pow(depth / kDepths[0], power_ - 1) / kDepths[0];
    return {values_[0] * depth * part, power_ * values_[0] * part};
  }
  // Below the last node: the image acts like a dipole at twice the depth of the centre.
  Value atDepth(double depth) const {
    const double last = kDepths[kNodes - 1] - 1, deep = kDeep - 1, x = std::min(depth, kDeep) - 1;
    const auto cubed = [](double a) { return 1 / (a * a * a); };
    const double missing = (kFree - values_[kNodes - 1]) / (cubed(last) - cubed(deep));
    return {kFree - missing * (cubed(x) - cubed(deep)),
            depth < kDeep ? 3 * missing * cubed(x) / x : 0};
  }

  const double (&values_)[kNodes];
  double power_;
  std::array<double, kNodes> nodes_, slopes_;
};

}  // namespace

SphereInertia sphereInertiaAt(double depth) noexcept {
  static const Column along(kAlong, 1.5), across(kAcross, 2);
  const double d = std::max(0.0, depth);
  const Value a = along.at(d), c = across.at(d);
  AMBIENT_ASSERT(!(a.value < 0) && !(c.value < 0));
  return {a.value, c.value, a.slope, c.slope};
}

WettedSphere::WettedSphere(const FluidBody& body)
    : WettedInertia(body.added_mass), centre_(body.centre_of_volume), radius_(body.sphere_radius) {}

Matrix6 WettedSphere::inertiaAt(const Immersion& at) const noexcept {
  const SphereInertia k = sphereInertiaAt(at.draught() / radius_);
  const double volume = radius_ * radius_ * radius_;
  const Vector3& s = at.plane.normal;
  Matrix6 about_centre = Matrix6::Zero();
  about_centre.bottomRightCorner<3, 3>() =
      volume * (k.across * Matrix3::Identity() + (k.along - k.across) * s * s.transpose());
  return shiftOrigin(about_centre, -centre_);
}

InertiaGradient WettedSphere::gradientAt(const Immersion& at, const Twist& twist) const noexcept {
  const SphereInertia k = sphereInertiaAt(at.draught() / radius_);
  const double volume = radius_ * radius_ * radius_;
  const Vector3& s = at.plane.normal;
  const Vector3 v = twist.at(centre_);
  const double rise = s.dot(v);
  const double by_height =
      0.5 * volume / radius_ *
      (k.across_slope * v.squaredNorm() + (k.along_slope - k.across_slope) * rise * rise);
  // The depth of the lowest point is h - s.c + R.
  return {by_height, volume * (k.along - k.across) * rise * v - by_height * centre_};
}

}  // namespace ambient
