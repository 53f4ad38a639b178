#include "bullet_ambient/spatial/positive_inverse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

Matrix6 arbitraryMatrix(test::Arbitrary& arbitrary) {
  Matrix6 A;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) A(i, j) = arbitrary.between(-1, 1);
  return A;
}

TEST(PositiveInverse, IsTheInverse) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 100; ++i) {
    const Matrix6 A = arbitraryMatrix(arbitrary);
    Vector6 scale;
    for (int k = 0; k < 6; ++k) scale[k] = std::pow(10, arbitrary.between(-4, 4));
    const Matrix6 unscaled = A * A.transpose() + 0.1 * Matrix6::Identity();
    const Matrix6 K = scale.asDiagonal() * unscaled * scale.asDiagonal();
    const auto inverse = positiveInverse(K);
    ASSERT_TRUE(inverse);
    const Matrix6 back = scale.asDiagonal() * *inverse * scale.asDiagonal();
    // Condition numbers are below 200.
    EXPECT_LT((unscaled * back - Matrix6::Identity()).norm(), 1e-12);
    EXPECT_EQ(*inverse, inverse->transpose());
  }
}

TEST(PositiveInverse, IsNoneOfOtherMatrices) {
  test::Arbitrary arbitrary(2);
  for (int i = 0; i < 6; ++i) {
    const Matrix6 A = arbitraryMatrix(arbitrary);
    Matrix6 K = A * A.transpose() + Matrix6::Identity();
    K(i, i) = -0.1;
    EXPECT_FALSE(positiveInverse(K)) << i;
    K(i, i) = std::nan("");
    EXPECT_FALSE(positiveInverse(K)) << i;
  }
  EXPECT_FALSE(positiveInverse(Matrix6::Zero()));
}

}  // namespace
}  // namespace ambient
