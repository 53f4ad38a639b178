#include "preprocess/potential_flow/operators/solid_harmonics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace ambient {
namespace {

using Eigen::MatrixXf;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd regularAt(const SolidHarmonics& harmonics, const Vector3d& a) {
  VectorXd values(harmonics.count());
  harmonics.evaluateRegular(a, values);
  return values;
}

TEST(SolidHarmonics, ExpandTheInverseDistance) {
  const Vector3d source_centre(0.3, 0.2, -0.1), target_centre(2.3, 1.2, 0.7);
  const double source_scale = 0.4, target_scale = 0.5;
  const Vector3d offset = target_centre - source_centre;
  for (int degree = 1; degree <= 8; ++degree) {
    const SolidHarmonics harmonics(degree);
    MatrixXf transfer;
    harmonics.fillTransfer(offset, target_scale, source_scale, transfer);
    for (int k = 0; k < 20; ++k) {
      const Vector3d a = Vector3d(std::sin(k), std::sin(3 * k + 1), std::cos(2 * k)).normalized();
      const Vector3d b = Vector3d(std::cos(5 * k), std::sin(k + 2), std::sin(7 * k)).normalized();
      const double value =
          regularAt(harmonics, a).transpose() * transfer.cast<double>() * regularAt(harmonics, b);
      const double distance = (offset + target_scale * a - source_scale * b).norm();
      // Bound of the first omitted term; then single precision.
      const double ratio = (target_scale + source_scale) / offset.norm();
      EXPECT_LT(std::abs(value * distance - 1), 2 * std::pow(ratio, degree + 1) + 1e-6)
          << degree << " " << k;
    }
  }
}

TEST(SolidHarmonics, ShiftsAreExact) {
  const SolidHarmonics harmonics(5);
  const Vector3d from(0.2, -0.1, 0.3), to(0.5, 0.4, -0.2), y(0.1, 0.25, 0.15);
  const double from_scale = 0.5, to_scale = 1.3;
  MatrixXf shift;
  harmonics.fillShift((from - to) / to_scale, from_scale / to_scale, shift);
  const VectorXd shifted = shift.cast<double>() * regularAt(harmonics, (y - from) / from_scale);
  const VectorXd expected = regularAt(harmonics, (y - to) / to_scale);
  // Single precision.
  EXPECT_LT((shifted - expected).norm(), 2e-7 * expected.norm());
}

TEST(SolidHarmonics, SlopeIsTheDerivative) {
  const SolidHarmonics harmonics(5);
  const Vector3d a(0.4, -0.3, 0.6), direction(0.2, 1.1, -0.7);
  VectorXd slope(harmonics.count());
  harmonics.evaluateSlope(a, direction, slope);
  const double h = 1e-4;
  const VectorXd difference =
      (regularAt(harmonics, a + h * direction) - regularAt(harmonics, a - h * direction)) / (2 * h);
  EXPECT_LT((slope - difference).norm(), 1e-7 * slope.norm());
}

}  // namespace
}  // namespace ambient
