#include "preprocess/added_mass_tables/known_added_mass.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/added_mass_tables/table_places.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {

namespace {

/// Clenshaw's sum of c_i T_i(x), where coefficient(i) is c_i.
template <class Coefficient>
double chebyshevSum(int count, double x, const Coefficient& coefficient) {
  double last = 0, before = 0;
  for (int i = count - 1; i > 0; --i) {
    const double next = coefficient(i) + 2 * x * last - before;
    before = last;
    last = next;
  }
  return coefficient(0) + x * last - before;
}

}  // namespace

double ChebyshevSeries::operator()(double x, double y) const {
  return chebyshevSum(rows, x, [&](int i) {
    return chebyshevSum(columns, y, [&](int j) { return coefficients[i * columns + j]; });
  });
}

namespace {

double logOfRatio(double numerator, double denominator) {
  return portable::log(numerator / denominator) / portable::log(kLargestRatio);
}

RevolutionInertia roundScale(double radius, double height) {
  const double sum = radius + height, area = radius * radius;
  return {area * radius, area * height * height / sum, area * sum * sum * sum, area * height * sum};
}

}  // namespace

TablePlace BoxAxis::place() const {
  const double across = logOfRatio(std::max(b, c), std::min(b, c));
  return {logOfRatio(a * a, b * c) / 2, 2 * across * across - 1};
}

double BoxAxis::translationScale() const { return b * c * (b * c) / (b + c); }

double BoxAxis::rotationScale() const {
  const double sum = b + c;
  return a * a * (sum * sum) * (sum * sum) / (a + 0.2 * sum);
}

RoundPlace cylinderPlace(double radius, double height) {
  return {{logOfRatio(height, 2 * radius), 0}, roundScale(radius, height)};
}

RoundPlace capsulePlace(double radius, double height) {
  const double slenderness = height / (2 * radius);
  const Vector6 spheroid = ellipsoidAddedMass({radius, radius, radius + height / 2});
  return {{2 * portable::log1p(slenderness) / portable::log1p(kLargestRatio) - 1, 0},
          {spheroid[5], spheroid[3], spheroid[0], 0}};
}

RoundPlace conePlace(double radius, double height, double rounding) {
  const double thickness = radius * height / (radius + height);
  const double share = rounding / (rounding + thickness);
  // The root, for a sharp edge is a singular limit.
  RoundPlace round{{logOfRatio(height, 2 * radius), 2 * std::sqrt(share / kLargestRounding) - 1},
                   roundScale(radius + rounding, height + 2 * rounding)};
  // A body that is rounded to a ball does not turn the fluid.
  const double oblong = (radius + height) / (radius + height + rounding);
  round.scale.w_y *= oblong * oblong;
  return round;
}

namespace {

std::optional<Matrix6> lookUp(const RoundTable& table, const RoundPlace& round) {
  if (!round.place.isInside()) return std::nullopt;
  const auto [x, y] = round.place;
  RevolutionInertia inertia;
  inertia.v_z = round.scale.v_z * portable::exp(table.v_z(x, y));
  inertia.v_x = round.scale.v_x * portable::exp(table.v_x(x, y));
  inertia.w_y = round.scale.w_y * table.w_y(x, y);
  if (table.coupling.rows > 0) inertia.coupling = round.scale.coupling * table.coupling(x, y);
  return inertia.matrix();
}

}  // namespace

std::string addedMassTablesName() { return "added mass tables " + std::to_string(kTableRevision); }

std::optional<Matrix6> boxAddedMass(const Vector3& half_sizes) {
  AMBIENT_ASSERT(half_sizes.minCoeff() > 0 && half_sizes.allFinite());
  const BoxTable& table = boxTable();
  Matrix6 K = Matrix6::Zero();
  for (int k = 0; k < 3; ++k) {
    const BoxAxis axis{half_sizes[k], half_sizes[(k + 1) % 3], half_sizes[(k + 2) % 3]};
    if (half_sizes[k] > kLargestRatio * half_sizes.minCoeff()) return std::nullopt;
    const auto [x, y] = axis.place();
    K(k, k) = axis.rotationScale() * table.rotation(x, y);
    K(3 + k, 3 + k) = axis.translationScale() * portable::exp(table.translation(x, y));
  }
  return K;
}

std::optional<Matrix6> cylinderAddedMass(double radius, double height) {
  return lookUp(cylinderTable(), cylinderPlace(radius, height));
}

std::optional<Matrix6> capsuleAddedMass(double radius, double height) {
  return lookUp(capsuleTable(), capsulePlace(radius, height));
}

std::optional<Matrix6> coneAddedMass(double radius, double height, double rounding) {
  return lookUp(coneTable(), conePlace(radius, height, rounding));
}

}  // namespace ambient
