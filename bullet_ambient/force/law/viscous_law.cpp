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

/// The ball's numbers: Thwaites' and Buri's integrals, docs/theory.md section 18.
constexpr double kBallThickness = 0.3578988, kBallBubble = 0.5920629, kBallSmooth = 0.6556696,
                 kBallRough = 0.9136464, kBallBubbleFriction = 0.09288118,
                 kBallNoseFriction = 0.3619262;

double square(double x) { return x * x; }
/// x^8/(1 + x^8).
double steep(double x) {
  constexpr double kMost = 1e3;
  const double to8 = square(square(square(std::min(x, kMost))));
  return to8 / (1 + to8);
}

/// g of eq. (111).
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
/// Factor of eq. (112) on l_t where attached flow makes little pressure; `power`: b times `whole`.
double fadedBy(double power, double whole, double g) {
  return power > 0 ? 1 - g * power / (power + kAttached * whole) : 1;
}

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

// Measured drag knows where the flow leaves.
Vector3 smoothShares(const FluidBody& body, const FormShape& shape) {
  if (!body.drag.isZero(0)) return {0, 0, 0};
  const double edges = body.viscous.is_primitive ? 1 : std::max(0.0, 1 - 2 * shape.edges);
  return edges * (1 - shape.wing) * body.viscous.separation.smooth_base;
}

ViscousLaw::ViscousLaw(const FluidBody& body, const FormShape& shape, const Vector3& own_drag,
                       const ViscousFluid& fluid)
    : density_(fluid.density),
      diameter_(body.viscous.surface.diameter),
      area_(body.area),
      sharp_share_(body.viscous.sharp_share),
      relative_roughness_(fluid.roughness / diameter_),
      reynolds_per_speed_(fluid.density * diameter_ / fluid.viscosity),
      turn_speed_(1.5 / diameter_ * body.viscous.surface.gyration) {
  const ViscousForm& viscous = body.viscous;
  const Matrix6 at_reaction = shiftOrigin(viscous.resistance, viscous.centre_of_reaction);
  resistance_ = {fluid.viscosity * at_reaction, viscous.centre_of_reaction};
  drag_ = at_reaction.bottomRightCorner<3, 3>() / (3 * kPi * diameter_);
  turn_drag_ = drag_.trace() / 3;
  setAerofoils(body);
  Smooth smooth;
  smooth.share = smoothShares(body, shape);
  if (smooth.share.isZero(0)) return;
  const Matrix3& q = smooth.axes = viscous.separation.axes;
  for (int j = 0; j < 3; ++j) smooth.projections[j] = q.col(j) * q.col(j).transpose();
  setTurning(body, smooth);
  setWays(body, own_drag, smooth);
  setTail(body, shape, smooth);
  smooth_ = std::make_unique<const Smooth>(smooth);
}

void ViscousLaw::setTurning(const FluidBody& body, Smooth& to) const {
  const Vector3& m = body.viscous.surface.moments;
  Vector3 even(1, 1, 1);  // (1 - nu_i)^4
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    const double sum = m[j] + m[l];
    if (!(sum > 0)) continue;
    const double uneven = std::abs(m[j] - m[l]) / sum;
    to.uneven(i, j) = uneven * m[l] / sum;
    to.uneven(i, l) = uneven * m[j] / sum;
    even[i] = square(square(1 - uneven));
  }
  to.spin_mass = density_ * body.volume / 2 * to.axes * even.asDiagonal() * to.axes.transpose();
}

void ViscousLaw::setWays(const FluidBody& body, const Vector3& own_drag, Smooth& to) const {
  constexpr double kBallLaminarFriction = 6.586;
  for (int axis = 0; axis < 3; ++axis) {
    const double chi = to.share[axis], own = own_drag[axis];
    const double frontal = body.viscous.surface.frontal[axis];
    const double drag = 3 * kPi * to.axes.col(axis).dot(drag_ * to.axes.col(axis));  // R_jj/D_A
    const double per_ball = square(diameter_) * drag * std::sqrt(drag / (3 * kPi));
    const auto kept = [&](double k) {
      if (!(own > 0)) return 1.0;
      return 1 - chi * (1 - portable::cbrt(std::min(1.0, kSuction * k / own)));
    };
    for (const int side : {0, 1}) {
      const SeparationWay& of = body.viscous.separation.ways[2 * axis + side];
      const int way = axis + 3 * side;
      const double beta = 3 * of.friction_laminar / kBallLaminarFriction * frontal / per_ball;
      to.thickness_sq[way] = square(of.thickness);
      to.layer[way] = beta > 0 ? 0.25 + chi * (3 / (16 * beta) - 0.75) : 0.25;
      to.laminar[way] = kept(of.wake_laminar);
      to.bubble[way] = kept(of.wake_bubble);
      to.smooth[way] = kept(of.wake_turbulent);
      to.rough[way] = kept(of.wake_rough);
      to.bubble_friction[way] = frontal * chi * of.friction_bubble;
      to.nose_friction[way] = frontal * chi * of.friction_turbulent;
    }
  }
}

void ViscousLaw::setTail(const FluidBody& body, const FormShape& shape, Smooth& to) const {
  if (!shape.isSlender() || !(body.volume > 0)) return;
  const Vector3 masses = symmetricEigen<3>(body.added_mass.bottomRightCorner<3, 3>()).values;
  const ViscousForm& viscous = body.viscous;
  to.tail = density_ * viscous.surface.frontal[0] * shape.slender.squaredNorm() *
            ((masses[1] + masses[2]) / 2 - masses[0]) / body.volume;
  to.tail_place = kTailPlace * std::sqrt(viscous.surface.moments[0]);
  for (const int way : {0, 1}) {
    const SeparationWay& of = viscous.separation.ways[way];
    to.tail_ways[way] = {of.wake_laminar, of.wake_bubble, of.wake_turbulent, of.wake_rough};
  }
}

ViscousLaw::Scalars ViscousLaw::scalars(const Twist& x) const noexcept {
  Scalars s;
  const Vector3 &w = x.angular, v = x.at(resistance_.centre);
  const double spin_sq = w.squaredNorm(), turning = w.dot(turn_speed_ * w);
  const double turn_sq = spin_sq > 0 ? turning / spin_sq * turning : 0;  // u_w^2
  const double speed_sq = v.squaredNorm() + turn_sq;
  s.speed = std::sqrt(speed_sq);
  s.moves = s.speed > 0;
  if (!s.moves) return s;
  const double reynolds = std::min(reynolds_per_speed_ * s.speed, kMostReynolds);
  s.sharp_growth = wakeGrowth(sharp_share_, reynolds);
  s.pressure = s.munk = (1 + s.sharp_growth) / 2;
  double layer = 0.25;
  if (smooth_) {
    layer = addLayers(s, reynolds, v / s.speed, turn_sq / speed_sq);
  } else if (relative_roughness_ > 0) {
    s.layers = layerState(0, reynolds, relative_roughness_);
  }
  const double Q = reynolds * (v.dot(drag_ * v) + turn_sq * turn_drag_) / speed_sq;
  const double of_smooth = s.smooth * s.layers.turbulent * s.layers.from_nose;
  const double of_rest = (1 - s.smooth) * square(std::max(0.0, 1 - kPlateTransition / reynolds));
  const double laminar = 1 - of_smooth - of_rest;
  const double rough = s.layers.roughness * std::sqrt(reynolds) * reynoldsPower(reynolds);
  double along = laminar + kPlate * rough * of_rest;
  if (aerofoils_ > 0) along += aerofoils_ * (alongAerofoils(s, reynolds) - along);
  s.of_moving = along * translationGrowth(Q, layer);
  s.of_turning = (laminar + kDisc * rough * (of_smooth + of_rest)) * rotationGrowth(reynolds);
  return s;
}

void ViscousLaw::setAerofoils(const FluidBody& body) {
  double area = 0, chord = 0;
  for (const Wing& wing : body.wings) {
    if (wing.nose == 0) continue;
    area += 2 * wing.span * wing.chord;
    chord += 2 * wing.span * wing.chord * wing.chord;
  }
  if (!(area > 0)) return;
  aerofoils_ = std::min(1.0, area / area_);
  aerofoil_chord_ = chord / area / diameter_;
}

/// Friction on aerofoils over that of laminar layers: l_t of eq. (112) with the Reynolds number of
/// their chord, eq. (161f).
double ViscousLaw::alongAerofoils(const Scalars& s, double reynolds) const noexcept {
  constexpr double kTransition = 3e5;  // fitted on NACA 0012
  const double of_chord = aerofoil_chord_ * reynolds;
  const double turbulent = (1 - s.smooth) * square(std::max(0.0, 1 - kTransition / of_chord));
  const double laminar = 1 - s.smooth * s.layers.turbulent * s.layers.from_nose - turbulent;
  const double rough = s.layers.roughness * std::sqrt(of_chord) * reynoldsPower(of_chord);
  return laminar + kPlate * rough * turbulent;
}

/// Adds what depends on the state of the layers. Returns the mean of x, eq. (109).
double ViscousLaw::addLayers(Scalars& s, double reynolds, const Vector3& direction,
                             double turn_sq) const noexcept {
  const Smooth& of = *smooth_;
  const Vector3 e = of.axes.transpose() * direction;
  const Vector3 along_sq = (e.array().square() + turn_sq / 3).matrix();  // E_j
  Ways ahead;                                                            // p_+-j
  for (int j = 0; j < 3; ++j) {
    const double more = e[j] * (3 - e[j] * e[j]) / 4;
    ahead[j] = 0.5 + more;
    ahead[3 + j] = 0.5 - more;
  }
  s.ahead = ahead[0];
  Ways weights;
  weights.head<3>() = along_sq.array() * ahead.head<3>();
  weights.tail<3>() = along_sq.array() * ahead.tail<3>();
  s.layers =
      layerState(std::sqrt((weights * of.thickness_sq).sum()), reynolds, relative_roughness_);
  const Ways kept = ahead * s.layers.blend<Ways>(of.laminar, of.bubble,
                                                 s.layers.atNose(of.smooth, of.rough).min(1.0));
  s.moving = (kept.head<3>() + kept.tail<3>()).matrix();
  s.turning -= of.uneven * (Vector3::Ones() - s.moving);
  s.munk *= along_sq.dot(s.moving);
  s.smooth = along_sq.dot(of.share);
  s.layer_area = reynoldsPower(reynolds) *
                 s.layers.blend<double>(0, (weights * of.bubble_friction).sum(),
                                        s.layers.roughness * (weights * of.nose_friction).sum());
  return (weights * of.layer).sum();
}

Growth ViscousLaw::growth(const Scalars& s, double power) const noexcept {
  const double whole = density_ * s.speed * s.speed * s.speed * area_ / 2;
  const double faded = fadedBy(power, whole, s.sharp_growth);
  return {std::sqrt(1 + s.of_turning), std::sqrt(1 + faded * s.of_moving)};
}

Wrench ViscousLaw::smoothLoad(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept {
  Wrench load = tailLoad(s, w, v);
  load.force += spinForce(s, w, v);
  return load;
}

Vector3 ViscousLaw::layerForce(const Scalars& s, const Vector3& v) const noexcept {
  return -density_ / 2 * v.norm() * s.layer_area * v;
}

Wrench ViscousLaw::tailLoad(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept {
  const Smooth& of = *smooth_;
  if (!(of.tail > 0)) return {};
  const Vector3 axis = of.axes.col(0);
  const double along = axis.dot(v);
  const auto kept = [&](const std::array<double, 4>& k) {
    return std::min(1.0, std::sqrt(s.layers.blend(k[0], k[1], s.layers.atNose(k[2], k[3]))));
  };
  const double mean = s.ahead * kept(of.tail_ways[0]) + (1 - s.ahead) * kept(of.tail_ways[1]);
  const double slope = of.tail * (kTailLost + (1 - kTailLost) * mean);
  const Vector3 place = (along > 0 ? -of.tail_place : of.tail_place) * axis;
  Vector3 there = v + w.cross(place);
  there -= axis.dot(there) * axis;
  return Wrench::ofForceAt(-s.pressure * slope * std::abs(along) * there, place);
}

Vector3 ViscousLaw::spinForce(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept {
  const double across_sq = w.cross(v).squaredNorm(), speed_sq = v.squaredNorm();
  if (!(across_sq > 0) || !(speed_sq > 0)) return {0, 0, 0};
  const double S = diameter_ / 2 * (std::sqrt(across_sq) / speed_sq);
  const SpinLift of = spinLift(S, s.layers);
  constexpr double kLeastSpin = 1e-4;
  const double crisis = S > kLeastSpin ? 0.75 * of.crisis / S : 0;
  const double lambda = 0.75 * of.fresh - crisis;
  const Vector3 fresh = s.smooth * (smooth_->spin_mass * w).cross(v);
  const double drag = kLiftDrag * square(lambda) * fresh.squaredNorm() /
                      (density_ / 8 * area_ * speed_sq * std::sqrt(speed_sq));
  return (lambda - 1) * fresh - drag * v;
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
  const double speed_sq = v.squaredNorm(), speed = std::sqrt(speed_sq);
  const double U = std::sqrt(speed_sq + square(radius / 2) * w.squaredNorm());
  if (!(U > 0)) {
    if (fluid.viscosity > 0) load.growth = kCreeping;
    return load;
  }
  const double section = kPi * radius * radius;
  LayerState layers;
  double g = 1, friction = 0, suction3 = 1;
  if (fluid.viscosity > 0) {
    const double diameter = 2 * radius;
    const double reynolds = std::min(fluid.density * diameter * U / fluid.viscosity, kMostReynolds);
    layers = layerState(kBallThickness, reynolds, fluid.roughness / diameter);
    g = wakeGrowth(0, reynolds);
    load.suction =
        layers.blend(1.0, kBallBubble, std::min(1.0, layers.atNose(kBallSmooth, kBallRough)));
    suction3 = square(load.suction) * load.suction;
    const double z = reynoldsPower(reynolds), of_nose = layers.turbulent * layers.from_nose;
    friction = z * layers.blend(0.0, kBallBubbleFriction, layers.roughness * kBallNoseFriction);
    const double faded = fadedBy(suction3 * speed_sq * speed, 8 * U * U * U, g);
    const double l_turning =
        1 - of_nose + kDisc * layers.roughness * std::sqrt(reynolds) * z * of_nose;
    load.growth = {std::sqrt(1 + l_turning * rotationGrowth(reynolds)),
                   std::sqrt(1 + (1 - of_nose) * faded * translationGrowth(reynolds, 0.25))};
  }
  load.share = (1 + g) / 2;
  const double dynamic = fluid.density / 2 * section * speed;
  const Vector3 across = w.cross(v);
  const double across_sq = across.squaredNorm();
  if (across_sq > 0 && speed_sq > 0) {
    const double S = radius * (std::sqrt(across_sq) / speed_sq);
    const SpinLift of = spinLift(S, layers);
    const double slope = of.fresh - of.crisis / S;  // C_L/S
    load.whole = dynamic * (radius * slope / speed * across - kLiftDrag * square(slope * S) * v);
  }
  load.pressure.force = -dynamic * load.share * suction3 / 2 * v + load.whole;
  load.layer.force = -dynamic * friction * v;
  return load;
}

}  // namespace ambient
