#include "preprocess/potential_flow/surface/quadrature_rules.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ambient {
namespace {

double factorial(int n) { return std::tgamma(n + 1.0); }

/// Largest error of the mean of l1^i l2^j l3^k over the triangle, i + j + k = degree.
template <std::size_t N>
double errorOfDegree(const std::array<TriangleNode, N>& rule, int degree) {
  double worst = 0;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j) {
      const int k = degree - i - j;
      double mean = 0;
      for (const TriangleNode& node : rule)
        mean += node.weight * std::pow(node.barycentric[0], i) * std::pow(node.barycentric[1], j) *
                std::pow(node.barycentric[2], k);
      const double exact = 2 * factorial(i) * factorial(j) * factorial(k) / factorial(degree + 2);
      worst = std::max(worst, std::abs(mean - exact));
    }
  return worst;
}

TEST(QuadratureRules, SegmentRuleIsExactToDegree11) {
  for (int degree = 0; degree <= 12; ++degree) {
    double mean = 0;
    for (const SegmentNode& node : kSegmentRule)
      mean += node.weight * std::pow(node.position, degree);
    const double error = std::abs(mean - 1.0 / (degree + 1));
    if (degree <= 11)
      EXPECT_LT(error, 1e-16 * 4) << degree;
    else
      EXPECT_GT(error, 1e-9);
  }
}

TEST(QuadratureRules, TriangleRulesAreExactToDegree4And8) {
  for (int degree = 0; degree <= 4; ++degree)
    EXPECT_LT(errorOfDegree(kTriangleRule6, degree), 4e-16);
  for (int degree = 0; degree <= 8; ++degree)
    EXPECT_LT(errorOfDegree(kTriangleRule16, degree), 4e-16);
  EXPECT_GT(errorOfDegree(kTriangleRule6, 5), 1e-6);
  EXPECT_GT(errorOfDegree(kTriangleRule16, 9), 1e-8);
}

}  // namespace
}  // namespace ambient
