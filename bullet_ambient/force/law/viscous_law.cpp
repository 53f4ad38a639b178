#include "bullet_ambient/force/law/viscous_law.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

// Numbers of the law that were fitted or chosen, with their sources: docs/theory.md section 19.
constexpr double kCrisis = 205;        // V theta/nu where a laminar layer leaves in the crisis
constexpr double kCrisisAtNose = 500;  // where transition has reached the nose
constexpr double kRoughCrisis = 2.5;   // weight of the roughness in the crisis
constexpr double kSuction = 0.29;      // wake's C_D over k
constexpr double kRoughFriction = 0.034;
constexpr double kMostGrowth = 1.5;
constexpr double kWakeBySmooth = 1e4, kWakeBySharp = 300;  // Re at which a wake fills
constexpr double kPlateTransition = 1e5;                   // Re at which layers with edges turn
constexpr double kAttached = 0.02;                         // of b
constexpr double kPlate = 0.06, kDisc = 0.0377;  // turbulent over laminar friction over Re^0.3
constexpr double kLiftDrag = 0.7;
constexpr double kMostSpin = 2;
constexpr double kTailLost = 0.15, kTailPlace = 1.5;
constexpr double kMostReynolds = 1e60;  // keeps powers finite

/// The ball's numbers: Thwaites' and Buri's integrals, docs/theory.md section 18.
constexpr double kBallThickness = 0.3578988, kBallBubble = 0.5920629, kBallSmooth = 0.6556696,
                 kBallRough = 0.9136464, kBallBubbleFriction = 0.09288118,
                 kBallNoseFriction = 0.3619262;

double square(double x) { return x * x; }
/// sqrt(a^2 + b^2) of positive numbers, without overflow.
double hypotenuse(double a, double b) {
  const double large = std::max(a, b);
  return large > 0 ? large * std::sqrt(1 + square(std::min(a, b) / large)) : 0;
}
/// x^8/(1 + x^8).
double steep(double x) {
  constexpr double kMost = 1e3;
  const double to8 = square(square(square(std::min(x, kMost))));
  return to8 / (1 + to8);
}

/// g of eq. (110).
double wakeGrowth(double sharp_share, double reynolds) {
  const double p = reynolds * std::sqrt(reynolds);
  const auto grown = [p](double at) { return p / (p + at * std::sqrt(at)); };
  return sharp_share * grown(kWakeBySharp) + (1 - sharp_share) * grown(kWakeBySmooth);
}
double translationGrowth(double Q, double layer) {
  return 3.0 / 16 * Q / (1 + std::sqrt(Q) * (0.5 + layer * Q / (Q + 50)));
}
double rotationGrowth(double reynolds) {
  return 0.36 * (std::sqrt(std::sqrt(1 + square(reynolds / 8))) - 1);
}
/// Takes the part of eq. (112) out of l_t where attached flow makes little pressure.
double fadedBy(double b, double g) { return 1 - g * b / (b + kAttached); }

/// Coefficient of the lift of a ball that spins, eq. (119), but for S_p in its first two terms:
/// C_L = 0.19 S/(S + 0.035) + 0.39 S/(1 + 0.6 S) - crisis.
struct SpinLift {
  double fresh;   ///< the first two terms over S
  double crisis;  ///< the last
};
SpinLift spinLift(double S, const LayerState& layers) {
  const double S2 = std::min(S, kMostSpin), one = 1 + S2;
  const double to9 = square(square(square(one))) * one;
  return {0.19 / (S + 0.035) + 0.39 / (1 + 0.6 * S),
          0.2 * (steep(layers.onset * to9) - steep(layers.onset * (1 + 20 * S2 * S2)))};
}

}  // namespace

double LayerState::blend(double laminar, double bubble, double smooth, double rough,
                         double most) const {
  const double nose = std::min(most, smooth + (rough - smooth) * growth);
  return (1 - turbulent) * laminar + turbulent * ((1 - from_nose) * bubble + from_nose * nose);
}

LayerState layerState(double thickness, double reynolds, double relative_roughness) noexcept {
  LayerState state;
  const double y = thickness * std::sqrt(reynolds);
  const double rough = kRoughCrisis * relative_roughness * reynolds;
  if (relative_roughness > 0) {
    const double z = reynoldsPower(std::sqrt(kPi) * reynolds);
    const double smooth4 = square(square(kFrictionCoefficient * z));
    const double rough4 = square(square(kRoughFriction)) * relative_roughness / std::sqrt(kPi);
    state.roughness = std::sqrt(std::sqrt(1 + rough4 / smooth4));
    state.growth = std::min(std::sqrt(state.roughness) - 1, kMostGrowth);
  }
  if (!(y > 0)) return state;
  state.onset = y * y * (y + rough) / (kCrisis * kCrisis * kCrisis);
  state.turbulent = steep(state.onset);
  const double smooth_share = y / (y + rough);
  state.from_nose = 1 - smooth_share / (1 + square(square(y / kCrisisAtNose)));
  return state;
}

ViscousLaw::ViscousLaw(const FluidBody& body, const FormShape& shape, const Vector3& own_drag,
                       const ViscousFluid& fluid)
    : fluid_(fluid),
      axes_(body.viscous.separation.axes),
      centre_(body.centre_of_volume),
      gyration_(body.viscous.surface.gyration),
      diameter_(body.viscous.surface.diameter),
      area_(body.area),
      half_volume_(body.volume / 2),
      sharp_share_(body.viscous.sharp_share),
      frontal_(body.viscous.surface.frontal),
      moments_(body.viscous.surface.moments) {
  const ViscousForm& viscous = body.viscous;
  resistance_ = {fluid.viscosity * shiftOrigin(viscous.resistance, viscous.centre_of_reaction),
                 viscous.centre_of_reaction};
  drag_matrix_ =
      shiftOrigin(viscous.resistance, viscous.centre_of_reaction).bottomRightCorner<3, 3>();
  drag_trace_ = drag_matrix_.trace();
  const double edges = viscous.is_primitive ? 1 : std::max(0.0, 1 - 2 * shape.edges);
  share_ = edges * (1 - shape.wing) * viscous.separation.smooth_base;
  if (!body.drag.isZero(0)) share_.setZero();  // measured drag knows where the flow leaves
  is_smooth_ = !share_.isZero(0);
  for (int i = 0; i < 3; ++i) {
    const double a = moments_[(i + 1) % 3], b = moments_[(i + 2) % 3];
    uneven_[i] = a + b > 0 ? std::abs(a - b) / (a + b) : 0;
  }
  if (!is_smooth_) return;
  setWays(body, own_drag);
  const Vector3 masses = symmetricEigen<3>(body.added_mass.bottomRightCorner<3, 3>()).values;
  setTail(body, shape, masses);
}

void ViscousLaw::setWays(const FluidBody& body, const Vector3& own_drag) {
  constexpr double kBallLaminarFriction = 6.586;
  for (int axis = 0; axis < 3; ++axis) {
    const double chi = share_[axis], own = own_drag[axis];
    const double drag = axes_.col(axis).dot(drag_matrix_ * axes_.col(axis));
    const double per_ball = diameter_ * drag * std::sqrt(drag / (3 * kPi * diameter_));
    const auto kept = [&](double k) {
      if (!(own > 0)) return 1.0;
      return 1 - chi * (1 - portable::cbrt(std::min(1.0, kSuction * k / own)));
    };
    for (const int way : {2 * axis, 2 * axis + 1}) {
      const SeparationWay& of = body.viscous.separation.ways[way];
      const double beta =
          3 * of.friction_laminar / kBallLaminarFriction * frontal_[axis] / per_ball;
      const double layer = beta > 0 ? 0.25 + chi * (3 / (16 * beta) - 0.75) : 0.25;
      ways_[way] = {square(of.thickness),    of.friction_bubble,
                    of.friction_turbulent,   layer,
                    kept(of.wake_laminar),   kept(of.wake_bubble),
                    kept(of.wake_turbulent), kept(of.wake_rough)};
    }
  }
}

void ViscousLaw::setTail(const FluidBody& body, const FormShape& shape, const Vector3& masses) {
  if (!shape.isSlender() || !(body.volume > 0)) return;
  tail_ = 2 * shape.slender.squaredNorm() * ((masses[1] + masses[2]) / 2 - masses[0]) / body.volume;
  tail_place_ = kTailPlace * std::sqrt(moments_[0]);
  for (const int way : {0, 1}) {
    const SeparationWay& of = body.viscous.separation.ways[way];
    tail_ways_[way] = {of.wake_laminar, of.wake_bubble, of.wake_turbulent, of.wake_rough};
  }
}

double ViscousLaw::wayBlend(const Scalars& s, int axis, double Way::*number) const noexcept {
  return s.ahead[axis] * (ways_[2 * axis].*number) +
         (1 - s.ahead[axis]) * (ways_[2 * axis + 1].*number);
}

ViscousLaw::Scalars ViscousLaw::scalars(const Twist& x) const noexcept {
  Scalars s;
  const Vector3 &w = x.angular, v = x.at(resistance_.centre);
  const double spin = w.norm();
  const double by_spin = spin > 0 ? 1.5 * (w / spin).dot(gyration_ * w) / diameter_ : 0;
  s.speed = hypotenuse(v.norm(), by_spin);
  s.moves = s.speed > 0;
  if (!s.moves) return s;
  s.reynolds = std::min(fluid_.density * diameter_ * s.speed / fluid_.viscosity, kMostReynolds);
  const Vector3 direction = v / s.speed, e = axes_.transpose() * direction;
  const double turn_sq = square(by_spin / s.speed);
  for (int j = 0; j < 3; ++j) {
    s.along_sq[j] = e[j] * e[j] + turn_sq / 3;
    s.ahead[j] = (1 + e[j] * (3 - e[j] * e[j]) / 2) / 2;
  }
  s.sharp_growth = wakeGrowth(sharp_share_, s.reynolds);
  s.pressure = (1 + s.sharp_growth) / 2;
  double layer = 0.25;
  if (is_smooth_) {
    addLayers(s);
    layer = 0;
    for (int j = 0; j < 3; ++j) layer += s.along_sq[j] * wayBlend(s, j, &Way::layer);
  } else if (fluid_.roughness > 0) {
    s.layers = layerState(0, s.reynolds, fluid_.roughness / diameter_);
  }
  const double Q = s.reynolds *
                   (direction.dot(drag_matrix_ * direction) + turn_sq * drag_trace_ / 3) /
                   (3 * kPi * diameter_);
  s.h_moving = translationGrowth(Q, layer);
  s.h_turning = rotationGrowth(s.reynolds);
  const double of_smooth = s.smooth * s.layers.turbulent * s.layers.from_nose;
  const double of_rest = (1 - s.smooth) * square(std::max(0.0, 1 - kPlateTransition / s.reynolds));
  const double rest = 1 - of_smooth - of_rest;
  const double power = std::sqrt(s.reynolds) * reynoldsPower(s.reynolds);  // Re^0.3
  s.l_moving = rest + kPlate * s.layers.roughness * power * of_rest;
  s.l_turning = rest + kDisc * s.layers.roughness * power * (of_smooth + of_rest);
  return s;
}

void ViscousLaw::addLayers(Scalars& s) const noexcept {
  double thickness_sq = 0;
  for (int j = 0; j < 3; ++j) thickness_sq += s.along_sq[j] * wayBlend(s, j, &Way::thickness_sq);
  s.layers = layerState(std::sqrt(thickness_sq), s.reynolds, fluid_.roughness / diameter_);
  const LayerState& layers = s.layers;
  const double z = reynoldsPower(s.reynolds);
  for (int j = 0; j < 3; ++j) {
    const auto kept = [&](const Way& way) {
      return layers.blend(way.laminar, way.bubble, way.smooth, way.rough, 1);
    };
    const auto friction = [&](const Way& way) {
      return layers.turbulent * ((1 - layers.from_nose) * way.bubble_friction +
                                 layers.from_nose * layers.roughness * way.nose_friction);
    };
    const double ahead = s.ahead[j];
    s.moving[j] = ahead * kept(ways_[2 * j]) + (1 - ahead) * kept(ways_[2 * j + 1]);
    s.layer_area += z * s.along_sq[j] * frontal_[j] * share_[j] *
                    (ahead * friction(ways_[2 * j]) + (1 - ahead) * friction(ways_[2 * j + 1]));
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    const double sum = moments_[j] + moments_[l];
    if (!(sum > 0)) continue;
    const double mean = (s.moving[j] * moments_[l] + s.moving[l] * moments_[j]) / sum;
    s.turning[i] = 1 - uneven_[i] * (1 - mean);
  }
  s.smooth = s.along_sq.dot(share_);
}

Growth ViscousLaw::growth(const Scalars& s, double power) const noexcept {
  const double whole = fluid_.density * s.speed * s.speed * s.speed * area_ / 2;
  const double b = whole > 0 ? std::max(0.0, power) / whole : 0;
  const double faded = s.l_moving * fadedBy(b, s.sharp_growth);
  return {std::sqrt(1 + s.l_turning * s.h_turning), std::sqrt(1 + faded * s.h_moving)};
}

Vector3 ViscousLaw::layerForce(const Scalars& s, const Vector3& v) const noexcept {
  return -fluid_.density / 2 * v.norm() * s.layer_area * v;
}

Wrench ViscousLaw::tailLoad(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept {
  if (!(tail_ > 0)) return {};
  const Vector3 axis = axes_.col(0);
  const double along = axis.dot(v);
  double kept = 0;
  for (const int way : {0, 1}) {
    const auto& k = tail_ways_[way];
    const double share = way == 0 ? s.ahead[0] : 1 - s.ahead[0];
    constexpr double kNoLimit = 1e300;
    kept += share * std::min(1.0, std::sqrt(s.layers.blend(k[0], k[1], k[2], k[3], kNoLimit)));
  }
  const double slope = tail_ * (kTailLost + (1 - kTailLost) * kept);
  const Vector3 place = (along > 0 ? -tail_place_ : tail_place_) * axis;
  Vector3 there = v + w.cross(place);
  there -= axis.dot(there) * axis;
  return Wrench::ofForceAt(
      -s.pressure * fluid_.density / 2 * frontal_[0] * slope * std::abs(along) * there, place);
}

Vector3 ViscousLaw::spinForce(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept {
  const Vector3 across = w.cross(v);
  const double speed = v.norm(), across_size = across.norm();
  if (!(s.smooth > 0) || !(across_size > 0) || !(speed > 0)) return {0, 0, 0};
  const double S = diameter_ / 2 * (across_size / speed) / speed;
  const SpinLift of = spinLift(S, s.layers);
  constexpr double kLeastSpin = 1e-4;
  const double crisis = S > kLeastSpin ? 0.75 * of.crisis / S : 0;
  const double lambda = 0.75 * of.fresh - crisis;
  Vector3 even;
  for (int i = 0; i < 3; ++i) even[i] = s.smooth * square(square(1 - uneven_[i]));
  const Vector3 spin = axes_ * even.cwiseProduct(axes_.transpose() * w);
  const Vector3 fresh = fluid_.density * half_volume_ * spin.cross(v);
  const Vector3 lift = lambda * fresh;
  const double drag = kLiftDrag * lift.squaredNorm() / (fluid_.density / 8 * area_ * speed * speed);
  return (lambda - 1) * fresh - drag / speed * v;
}

Resistance ballResistance(double radius, double viscosity) noexcept {
  Resistance resistance;
  const double of_moving = 6 * kPi * viscosity * radius;
  resistance.matrix.diagonal() << Vector3::Constant(4.0 / 3 * of_moving * radius * radius),
      Vector3::Constant(of_moving);
  return resistance;
}

BallLoad computeBallLoad(double radius, const ViscousFluid& fluid, const Twist& x) noexcept {
  BallLoad load;
  const Vector3 &w = x.angular, &v = x.linear;
  const double speed = v.norm(), U = hypotenuse(speed, radius * w.norm() / 2);
  if (!(U > 0)) {
    if (fluid.viscosity > 0) load.growth = kCreeping;
    return load;
  }
  const double section = kPi * radius * radius;
  LayerState layers;
  double g = 1, friction = 0;
  if (fluid.viscosity > 0) {
    const double diameter = 2 * radius;
    const double reynolds = std::min(fluid.density * diameter * U / fluid.viscosity, kMostReynolds);
    layers = layerState(kBallThickness, reynolds, fluid.roughness / diameter);
    g = wakeGrowth(0, reynolds);
    load.suction = layers.blend(1, kBallBubble, kBallSmooth, kBallRough, 1);
    const double z = reynoldsPower(reynolds), of_nose = layers.turbulent * layers.from_nose;
    friction = z * (layers.turbulent * (1 - layers.from_nose) * kBallBubbleFriction +
                    of_nose * layers.roughness * kBallNoseFriction);
    const double b = square(load.suction) * load.suction * square(speed / U) * (speed / U) / 8;
    const double l_turning =
        1 - of_nose + kDisc * layers.roughness * std::sqrt(reynolds) * z * of_nose;
    const double l_moving = (1 - of_nose) * fadedBy(b, g);
    load.growth = {std::sqrt(1 + l_turning * rotationGrowth(reynolds)),
                   std::sqrt(1 + l_moving * translationGrowth(reynolds, 0.25))};
  }
  load.share = (1 + g) / 2;
  if (!(speed > 0)) return load;
  const double dynamic = fluid.density / 2 * section * speed;
  const Vector3 across = w.cross(v);
  const double S = radius * (across.norm() / speed) / speed;
  const SpinLift of = spinLift(S, layers);
  // C_L v^2 (w x v)/|w x v|, as C_L = S (fresh) - crisis.
  const double per_spin = S > 0 ? of.crisis / S : 0;
  const double lift = (of.fresh - per_spin) * S;
  load.whole =
      dynamic * (radius * (of.fresh - per_spin) / speed * across - kLiftDrag * lift * lift * v);
  const double suction3 = load.suction * load.suction * load.suction;
  load.pressure.force = -dynamic * load.share * suction3 / 2 * v + load.whole;
  load.layer.force = -dynamic * friction * v;
  return load;
}

}  // namespace ambient
