#include "bullet_ambient/force/law/propeller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/form_factors.h"
#include "bullet_ambient/force/medium/input_checks.h"

namespace ambient {
namespace {

/// Speed of the blades at 0.7 of the radius over n D.
constexpr double kBladeSpeed = 0.7 * kPi;

/// K_Q of an ideal disc with this thrust, (162) with n D = 1.
double leastTorque(const PropellerPoint& point) {
  const double through = point.advance + inducedVelocity(point.thrust, point.advance, kPi / 4);
  return point.thrust * through / (2 * kPi);
}

void checkTable(const std::vector<PropellerPoint>& points) {
  if (points.size() < 2)
    refuseInput("its table has ", points.size(), " points; must be at least 2");
  if (points.front().advance != 0)
    refuseInput("its table begins at J ", points.front().advance, "; must begin at 0, at rest");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PropellerPoint& point = points[i];
    if (!std::isfinite(point.advance) || !std::isfinite(point.thrust) ||
        !std::isfinite(point.torque))
      refuseInput("a number of its table is not finite");
    if (i > 0 && !(point.advance > points[i - 1].advance))
      refuseInput("its table has J ", point.advance, " after ", points[i - 1].advance,
                  "; must be above that");
    if (!(point.torque >= leastTorque(point)))
      refuseInput("its table has at J ", point.advance, " the torque K_Q ", point.torque, " (C_P ",
                  2 * kPi * point.torque, "); must be at least ", leastTorque(point),
                  ", that of an ideal disc with this thrust");
  }
}

/// A term C J^s (P/D)^t (A_E/A_0)^u Z^v of eq. (164).
struct Term {
  double factor;
  int s, t, u, v;
};

// Oosterveld and van Oossanen 1975, as printed in Bernitsas, Ray, Kinley 1981, table 1, for a
// Reynolds number of 2e6.
constexpr Term kThrustTerms[] = {
    {0.00880496, 0, 0, 0, 0},   {-0.204554, 1, 0, 0, 0},    {0.166351, 0, 1, 0, 0},
    {0.158114, 0, 2, 0, 0},     {-0.147581, 2, 0, 1, 0},    {-0.481497, 1, 1, 1, 0},
    {0.415437, 0, 2, 1, 0},     {0.0144043, 0, 0, 0, 1},    {-0.0530054, 2, 0, 0, 1},
    {0.0143481, 0, 1, 0, 1},    {0.0606826, 1, 1, 0, 1},    {-0.0125894, 0, 0, 1, 1},
    {0.0109689, 1, 0, 1, 1},    {-0.133698, 0, 3, 0, 0},    {0.00638407, 0, 6, 0, 0},
    {-0.00132718, 2, 6, 0, 0},  {0.168496, 3, 0, 1, 0},     {-0.0507214, 0, 0, 2, 0},
    {0.0854559, 2, 0, 2, 0},    {-0.0504475, 3, 0, 2, 0},   {0.010465, 1, 6, 2, 0},
    {-0.00648272, 2, 6, 2, 0},  {-0.00841728, 0, 3, 0, 1},  {0.0168424, 1, 3, 0, 1},
    {-0.00102296, 3, 3, 0, 1},  {-0.0317791, 0, 3, 1, 1},   {0.018604, 1, 0, 2, 1},
    {-0.00410798, 0, 2, 2, 1},  {-0.000606848, 0, 0, 0, 2}, {-0.0049819, 1, 0, 0, 2},
    {0.0025983, 2, 0, 0, 2},    {-0.000560528, 3, 0, 0, 2}, {-0.00163652, 1, 2, 0, 2},
    {-0.000328787, 1, 6, 0, 2}, {0.000116502, 2, 6, 0, 2},  {0.000690904, 0, 0, 1, 2},
    {0.00421749, 0, 3, 1, 2},   {0.0000565229, 3, 6, 1, 2}, {-0.00146564, 0, 3, 2, 2}};
constexpr Term kTorqueTerms[] = {
    {0.00379368, 0, 0, 0, 0},  {0.00886523, 2, 0, 0, 0},    {-0.032241, 1, 1, 0, 0},
    {0.00344778, 0, 2, 0, 0},  {-0.0408811, 0, 1, 1, 0},    {-0.108009, 1, 1, 1, 0},
    {-0.0885381, 2, 1, 1, 0},  {0.188561, 0, 2, 1, 0},      {-0.00370871, 1, 0, 0, 1},
    {0.00513696, 0, 1, 0, 1},  {0.0209449, 1, 1, 0, 1},     {0.00474319, 2, 1, 0, 1},
    {-0.00723408, 2, 0, 1, 1}, {0.00438388, 1, 1, 1, 1},    {-0.0269403, 0, 2, 1, 1},
    {0.0558082, 3, 0, 1, 0},   {0.0161886, 0, 3, 1, 0},     {0.00318086, 1, 3, 1, 0},
    {0.015896, 0, 0, 2, 0},    {0.0471729, 1, 0, 2, 0},     {0.0196283, 3, 0, 2, 0},
    {-0.0502782, 0, 1, 2, 0},  {-0.030055, 3, 1, 2, 0},     {0.0417122, 2, 2, 2, 0},
    {-0.0397722, 0, 3, 2, 0},  {-0.00350024, 0, 6, 2, 0},   {-0.0106854, 3, 0, 0, 1},
    {0.00110903, 3, 3, 0, 1},  {-0.000313912, 0, 6, 0, 1},  {0.0035985, 3, 0, 1, 1},
    {-0.00142121, 0, 6, 1, 1}, {-0.00383637, 1, 0, 2, 1},   {0.0126803, 0, 2, 2, 1},
    {-0.00318278, 2, 3, 2, 1}, {0.00334268, 0, 6, 2, 1},    {-0.00183491, 1, 1, 0, 2},
    {0.000112451, 3, 2, 0, 2}, {-0.0000297228, 3, 6, 0, 2}, {0.000269551, 1, 0, 1, 2},
    {0.00083265, 2, 0, 1, 2},  {0.00155334, 0, 2, 1, 2},    {0.000302683, 0, 6, 1, 2},
    {-0.0001843, 0, 0, 2, 2},  {-0.000425399, 0, 3, 2, 2},  {0.0000869243, 3, 3, 2, 2},
    {-0.0004659, 0, 6, 2, 2},  {0.0000554194, 1, 6, 2, 2}};

double wholePower(double base, int exponent) {
  double product = 1;
  for (int i = 0; i < exponent; ++i) product *= base;
  return product;
}

template <std::size_t kCount>
double sumOfTerms(const Term (&terms)[kCount], const WageningenScrew& screw, double advance) {
  double sum = 0;
  for (const Term& term : terms)
    sum += term.factor * wholePower(advance, term.s) * wholePower(screw.pitch_ratio, term.t) *
           wholePower(screw.area_ratio, term.u) * wholePower(screw.blades, term.v);
  return sum;
}

/// J at which a table has no thrust; where it ends before, by its last two points, at most 4.
double advanceWithoutThrust(const std::vector<PropellerPoint>& points) {
  constexpr double kMost = 4;
  std::size_t i = 1;
  while (i + 1 < points.size() && points[i].thrust > 0) ++i;
  const PropellerPoint &a = points[i - 1], &b = points[i];
  const double fall = a.thrust - b.thrust;
  if (!(fall > 0)) return kMost;
  return std::clamp(a.advance + (b.advance - a.advance) * a.thrust / fall, 0.0, kMost);
}

}  // namespace

PropellerPoint wageningenPoint(const WageningenScrew& screw, double advance) {
  return {advance, sumOfTerms(kThrustTerms, screw, advance),
          sumOfTerms(kTorqueTerms, screw, advance)};
}

double inducedVelocity(double thrust, double advance, double mass_per_length) noexcept {
  const double sign = thrust < 0 ? -1 : 1, along = sign * advance / 2;
  const double rest_sq = sign * thrust / (2 * mass_per_length);
  if (along >= 0) return sign * (std::sqrt(along * along + rest_sq) - along);
  if (along * along < rest_sq) return sign * std::sqrt(rest_sq);
  return sign * (-along - std::sqrt(along * along - rest_sq));
}

double Wash::shareOf(const Vector3& centre, const Vector3& half) const noexcept {
  const double beside = radius * radius - centre.squaredNorm();
  const double length_sq = half.squaredNorm(), skew = centre.dot(half);
  const double root_sq = skew * skew + length_sq * beside;
  if (!(root_sq > 0)) return beside > 0 ? 1 : 0;
  const double root = std::sqrt(root_sq);
  const double from = std::max(-length_sq, -skew - root), to = std::min(length_sq, -skew + root);
  return std::max(0.0, to - from) / (2 * length_sq);
}

double Wash::shareAt(double beside) const noexcept {
  constexpr double kEdge = 0.2;  // half of its width, over the radius
  return std::clamp(((1 + kEdge) * radius - beside) / (2 * kEdge * radius), 0.0, 1.0);
}

Wash washOf(double induced, double advance, double radius, double distance) noexcept {
  const double own = std::abs(induced), along = induced < 0 ? -advance : advance;
  if (!(distance > 0 && own > 0 && along + own > 0)) return {};
  const double cosine = distance / std::sqrt(distance * distance + radius * radius);
  const double velocity = own * (1 + cosine);
  const Wash core{velocity, radius * std::sqrt((along + own) / (along + velocity))};
  constexpr double kCoreLength = 12.4;  // over its radius
  const double spread = std::max(1.0, distance / (kCoreLength * core.radius));
  return {core.velocity / spread, core.radius * spread};
}

Propeller::Propeller(double diameter, std::vector<PropellerPoint> points,
                     const PropellerExtras& extras, double pitch_ratio)
    : diameter_(diameter), points_(std::move(points)), astern_(extras.astern) {
  if (!(diameter > 0) || !std::isfinite(diameter))
    refuseInput("its diameter is ", diameter, " m; must be above 0");
  InputChecks{}.within("its area_ratio", extras.area_ratio, 0, 2);
  InputChecks{}.within("its astern", extras.astern, 0, 1);
  const double slope = pitch_ratio / kBladeSpeed;  // tangent of the blades' pitch at 0.7 R
  stopped_.thrust = -kPi / 8 * kFlatDrag * extras.area_ratio / std::sqrt(1 + slope * slope);
  stopped_.torque = pitch_ratio / (2 * kPi) * stopped_.thrust;
}

Propeller Propeller::idealDisc(double diameter) { return {diameter, {}, {}, 0}; }

Propeller Propeller::byTable(double diameter, std::vector<PropellerPoint> points,
                             const PropellerExtras& extras) {
  checkTable(points);
  const double pitch_ratio = advanceWithoutThrust(points);
  return {diameter, std::move(points), extras, pitch_ratio};
}

Propeller Propeller::wageningen(double diameter, const WageningenScrew& screw) {
  InputChecks{}.within("its number of blades", screw.blades, 2, 7);
  InputChecks{}.within("its area_ratio", screw.area_ratio, 0.3, 1.05);
  InputChecks{}.within("its pitch_ratio", screw.pitch_ratio, 0.5, 1.4);
  constexpr int kPoints = 128;
  constexpr double kBeyond = 1.6;  // J over P/D, where no screw of the series has thrust
  std::vector<PropellerPoint> points;
  for (int i = 0; i <= kPoints; ++i) {
    points.push_back(wageningenPoint(screw, kBeyond * screw.pitch_ratio * i / kPoints));
    if (!(points.back().thrust > 0)) break;
  }
  checkTable(points);
  return {diameter, std::move(points), {screw.area_ratio, screw.astern}, screw.pitch_ratio};
}

double Propeller::area() const noexcept { return kPi / 4 * diameter_ * diameter_; }

// W^2 (W - V) = (T_0/(2 rho A))^(3/2), eq. (163). Newton's steps fall from above: the cubic is
// convex there.
PropellerLoad Propeller::discLoad(double rest_thrust, double advance,
                                  double density) const noexcept {
  if (!(density > 0) || rest_thrust == 0) return {};
  const double sign = rest_thrust < 0 ? -1 : 1, along = sign * advance;
  const double rest = std::sqrt(sign * rest_thrust / (2 * density * area()));
  double through = std::max(along, 0.0) + rest;
  constexpr int kMostSteps = 100;
  for (int i = 0; i < kMostSteps; ++i) {
    const double excess = through * through * (through - along) - rest * rest * rest;
    const double next = through - excess / (through * (3 * through - 2 * along));
    if (!(next < through)) break;
    through = next;
  }
  const double power = sign * rest_thrust * rest;
  return {sign * power / through, 0, power, sign * (through - along)};
}

Propeller::Specific Propeller::inTable(double advance) const noexcept {
  std::size_t i = 1;
  while (i + 1 < points_.size() && advance > points_[i].advance) ++i;
  const PropellerPoint &a = points_[i - 1], &b = points_[i];
  const double share = (advance - a.advance) / (b.advance - a.advance);
  return {a.thrust + share * (b.thrust - a.thrust), a.torque + share * (b.torque - a.torque)};
}

// Turns ahead or none, eq. (165). `turned`: n D [m/s]; `factor`: on the diagram.
Propeller::Specific Propeller::ahead(double turned, double advance, double factor) const noexcept {
  const double last = points_.back().advance;
  if (advance >= 0 && advance < last * turned) {
    const Specific k = inTable(advance / turned);
    const double scale = factor * turned * turned;
    return {scale * k.thrust, scale * k.torque};
  }
  const double end = advance < 0 ? 0 : last, sign = advance < 0 ? -1 : 1;
  const double from = portable::atan2(end, kBladeSpeed);
  const double angle = portable::atan2(sign * advance, kBladeSpeed * turned);
  const double stopped = (angle - from) / (kPi / 2 - from);
  const double blade_sq = kBladeSpeed * turned * kBladeSpeed * turned;
  const Specific k = inTable(end);
  const double of_table = (1 - stopped) * factor / (end * end + kBladeSpeed * kBladeSpeed);
  const double of_stopped = sign * stopped, speed_sq = advance * advance + blade_sq;
  return {speed_sq * (of_table * k.thrust + of_stopped * stopped_.thrust),
          speed_sq * (of_table * k.torque + of_stopped * stopped_.torque)};
}

PropellerLoad Propeller::load(double drive, double advance, double density) const noexcept {
  if (isIdealDisc()) return discLoad(drive, advance, density);
  if (!(density > 0)) return {};
  const double sign = drive < 0 ? -1 : 1, turns = sign * drive, along = sign * advance;
  const Specific of = ahead(turns * diameter_, along, drive < 0 ? astern_ : 1);
  const double thrust = density * diameter_ * diameter_ * of.thrust;
  double torque = density * diameter_ * diameter_ * diameter_ * of.torque;
  const double induced = inducedVelocity(thrust, along, density * area());
  const double turning = 2 * kPi * turns;
  if (turning > 0) torque = std::max(torque, thrust * (along + induced) / turning);
  return {sign * thrust, sign * torque, turning * torque, sign * induced};
}

double Propeller::dragAcross(const PropellerLoad& load, double turns, double advance,
                             double across) const noexcept {
  if (isIdealDisc()) return 0;
  const double profile = load.power - load.thrust * (advance + load.induced);
  const double tip = kPi * diameter_ * turns;
  const double speed_sq = tip * tip + advance * advance + across * across;
  return profile > 0 && speed_sq > 0 ? 2 * profile / speed_sq : 0;
}

}  // namespace ambient
