#include "bullet_ambient/force/law/shape_factors.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

template <class Number>
WingFactors<Number> wingFactorsOf(const FormShape& shape) {
  WingFactors<Number> factors;
  const double sigma = stallSine(shape.aspect), slope = normalForceSlope(shape.aspect);
  constexpr double kLeastWing = 1e-12;  // of W: keeps the inverse of k finite
  const double root = std::sqrt(std::max(shape.wing, kLeastWing));
  const double stall = std::sqrt(root) / (4 * sigma * sigma);
  factors.is_wing = shape.isWing();
  factors.is_slender = shape.isSlender();
  const double along = slope - normalForceSlope(1 / shape.aspect);
  const double span = std::sqrt(std::max(along, 0.0) / stall);
  factors.wing_root = static_cast<Number>(root);
  factors.stall = static_cast<Number>(stall);
  factors.slope = static_cast<Number>(slope / stall);
  for (int axis = 0; axis < 3; ++axis) {
    factors.facing[axis] = static_cast<Number>(shape.facing[axis]);
    factors.span[axis] = static_cast<Number>(span * shape.span[axis]);
    factors.slender[axis] = static_cast<Number>(shape.slender[axis]);
  }
  return factors;
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
      in_single(wingFactorsOf<float>(shape)),
      in_double(wingFactorsOf<double>(shape)) {
  AMBIENT_ASSERT(shape.aspect >= 1);
}

double ShapeFactors::wakeShare() const {
  constexpr double kSharp = 0.9;  // edges from which on a body sheds at once
  return std::max(0.0, 1 - shape.edges / kSharp);
}

double ShapeFactors::slipShare(double separation_cosine) const {
  if (!(separation_cosine < 0)) return 0;
  const double smooth = std::max(1 - 2 * shape.edges, 0.0);
  return smooth * std::min(1.0, 2 * separation_cosine * separation_cosine);
}

}  // namespace ambient
