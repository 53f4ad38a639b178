#include "preprocess/potential_flow/ellipsoid_added_mass.h"

#include <array>
#include <cmath>

#include "bullet_ambient/spatial/ambient_assert.h"
#include "bullet_ambient/spatial/pi.h"

namespace ambient {
namespace {

/// Carlson's R_D(x, y, z) = 3/2 int_0^inf dt / (sqrt((t + x) (t + y)) (t + z)^(3/2)). Every step
/// brings the arguments four times closer together; when they are one, R_D = z^(-3/2).
double integralD(Vector3 arguments) {
  constexpr int kSteps = 32;
  double sum = 0, weight = 1;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3 roots = arguments.cwiseSqrt();
    const double shift = roots.x() * roots.y() + roots.y() * roots.z() + roots.z() * roots.x();
    sum += weight / (roots.z() * (arguments.z() + shift));
    weight /= 4;
    arguments = (arguments.array() + shift) / 4;
  }
  return 3 * sum + weight / std::pow(arguments.z(), 1.5);
}

}  // namespace

Vector6 ellipsoidAddedMass(const Vector3& semi_axes) {
  AMBIENT_ASSERT(semi_axes.minCoeff() > 0 && semi_axes.allFinite());
  const double size = semi_axes.maxCoeff();
  const Vector3 axes = semi_axes / size, squares = axes.cwiseAbs2();
  const double volume = 4 * kPi / 3 * axes.prod();
  Vector3 demagnetisation;  // Lamb's alpha_0, beta_0, gamma_0; their sum is 2
  for (int k = 0; k < 3; ++k) {
    demagnetisation[k] =
        2.0 / 3 * axes.prod() * integralD({squares[(k + 1) % 3], squares[(k + 2) % 3], squares[k]});
  }
  Vector6 K = Vector6::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    K[3 + k] = volume * demagnetisation[k] / (2 - demagnetisation[k]) * std::pow(size, 3);
    const double difference = squares[i] - squares[j];
    if (difference == 0) continue;  // a body of revolution about k moves no fluid when it spins
    const double twist = demagnetisation[j] - demagnetisation[i];
    K[k] = volume / 5 * difference * difference * twist /
           (2 * difference - (squares[i] + squares[j]) * twist) * std::pow(size, 5);
  }
  return K;
}

}  // namespace ambient
