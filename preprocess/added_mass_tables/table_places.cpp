#include "preprocess/added_mass_tables/table_places.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
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

}  // namespace ambient
