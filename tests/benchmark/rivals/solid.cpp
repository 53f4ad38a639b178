#include "tests/benchmark/rivals/engine.h"

namespace ambient::rivals {
double volumeOf(const Solid& solid) {
  const auto [a, b, c] = solid.size;
  switch (solid.form) {
    case Form::kBox:
      return 8 * a * b * c;
    case Form::kCapsule:
      return kPi * a * a * (2 * b + 4.0 / 3 * a);
    case Form::kBall:
      return 4.0 / 3 * kPi * a * a * a;
    case Form::kEllipsoid:
      return 4.0 / 3 * kPi * a * b * c;
  }
  return 0;
}

Triple ellipsoidMoments(const Solid& ellipsoid) {
  const auto [a, b, c] = ellipsoid.size;
  const double fifth = ellipsoid.density * volumeOf(ellipsoid) / 5;
  return {fifth * (b * b + c * c), fifth * (c * c + a * a), fifth * (a * a + b * b)};
}

}  // namespace ambient::rivals
