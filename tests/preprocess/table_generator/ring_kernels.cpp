#include "tests/preprocess/table_generator/ring_kernels.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

struct EllipticIntegrals {
  double K, E;
};

/// Complete elliptic integrals by the arithmetic-geometric mean, from the complementary modulus:
/// accurate to rounding for the closest ring, too.
EllipticIntegrals ellipticIntegrals(double complementary) {
  double a = 1, g = complementary, power = 0.5;
  double sum = power * (1 - complementary) * (1 + complementary);
  while (a - g > 1e-16 * a) {
    const double c = (a - g) / 2;
    const double next = (a + g) / 2;
    g = std::sqrt(a * g);
    a = next;
    power *= 2;
    sum += power * c * c;
    if (c < 1e-9 * a) break;  // the next c is its square
  }
  const double K = kPi / (a + g);
  return {K, K * (1 - sum)};
}

}  // namespace

RingKernel ringKernel(const MeridianPoint& target, const MeridianPoint& source,
                      const Eigen::Vector2d& source_normal) {
  const double rise = source.y() - target.y();
  const double far = portable::hypot(source.x() + target.x(), rise);
  const double near = portable::hypot(source.x() - target.x(), rise);
  const EllipticIntegrals elliptic = ellipticIntegrals(near / far);
  const double twice_product = 2 * source.x() * target.x();
  const double squares = source.x() * source.x() + target.x() * target.x() + rise * rise;
  // int cos(m t) / R^n dt, from R^2 = squares - twice_product cos t.
  const double first_0 = 4 * elliptic.K / far;
  const double first_1 = (squares * first_0 - 4 * far * elliptic.E) / twice_product;
  const double third_0 = 4 * elliptic.E / (far * near * near);
  const double third_1 = (squares * third_0 - first_0) / twice_product;
  const double third_11 = (squares * third_1 - first_1) / twice_product;  // integral with cos^2
  const double along = source_normal.x() * source.x() + source_normal.y() * rise;
  const double across = source_normal.x() * target.x();
  constexpr double kShare = 1 / (4 * kPi);
  return {{kShare * first_0, kShare * first_1},
          {-kShare * (along * third_0 - across * third_1),
           -kShare * (along * third_1 - across * third_11)}};
}

}  // namespace ambient
