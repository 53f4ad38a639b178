#include "bullet_ambient/spatial/cholesky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

template <int N>
auto arbitraryInertia(test::Arbitrary& arbitrary) {
  typename Cholesky<N>::Matrix A;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) A(i, j) = arbitrary.between(-1, 1);
  return (A * A.transpose() + 0.1 * Cholesky<N>::Matrix::Identity()).eval();
}

// Random matrices with condition numbers below 200: rounding stays below 1e-13.
template <int N>
void expectThatItFactorises() {
  using Matrix = typename Cholesky<N>::Matrix;
  constexpr double kRounding = 1e-13;
  test::Arbitrary arbitrary(3);
  for (int i = 0; i < 100; ++i) {
    const Matrix A = arbitraryInertia<N>(arbitrary);
    const Cholesky<N> factor(A);
    ASSERT_TRUE(factor.isPositive());
    const Matrix L = factor.lower();
    EXPECT_TRUE(L.isLowerTriangular(0));
    EXPECT_LT((L * L.transpose() - A).norm(), kRounding);
    EXPECT_LT((A * factor.inverse() - Matrix::Identity()).norm(), 10 * kRounding);
    EXPECT_TRUE(factor.inverseTransposed().isUpperTriangular(0));
    EXPECT_LT((L.transpose() * factor.inverseTransposed() - Matrix::Identity()).norm(), kRounding);
    const typename Cholesky<N>::Vector b = A.col(0) - A.col(N - 1);
    EXPECT_LT((A * factor.solve(b) - b).norm(), 10 * kRounding);
  }
}

TEST(Cholesky, InvertsMatricesOfAnyScale) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 100; ++i) {
    Vector6 scale;
    for (int k = 0; k < 6; ++k) scale[k] = std::pow(10, arbitrary.between(-4, 4));
    const Matrix6 unscaled = arbitraryInertia<6>(arbitrary);
    const Matrix6 K = scale.asDiagonal() * unscaled * scale.asDiagonal();
    const Matrix6 inverse = Cholesky<6>(K).inverse();
    const Matrix6 back = scale.asDiagonal() * inverse * scale.asDiagonal();
    EXPECT_LT((unscaled * back - Matrix6::Identity()).norm(), 1e-12);
    EXPECT_EQ(inverse, inverse.transpose());
  }
}

TEST(Cholesky, FactorisesThreeRows) { expectThatItFactorises<3>(); }

TEST(Cholesky, FactorisesSixRows) { expectThatItFactorises<6>(); }

TEST(Cholesky, ReadsTheLowerHalfOnly) {
  test::Arbitrary arbitrary(4);
  Matrix6 A = arbitraryInertia<6>(arbitrary);
  const Matrix6 L = Cholesky<6>(A).lower();
  A(0, 5) = 1e9;
  EXPECT_EQ(Cholesky<6>(A).lower(), L);
}

TEST(Cholesky, IsNotPositiveOfOtherMatrices) {
  test::Arbitrary arbitrary(5);
  for (int i = 0; i < 6; ++i) {
    Matrix6 A = arbitraryInertia<6>(arbitrary);
    A(i, i) = -0.1;
    EXPECT_FALSE(Cholesky<6>(A).isPositive()) << i;
    A(i, i) = std::nan("");
    EXPECT_FALSE(Cholesky<6>(A).isPositive()) << i;
  }
  EXPECT_FALSE(Cholesky<3>(Matrix3::Zero()).isPositive());
  EXPECT_FALSE(Cholesky<6>().isPositive());
}

}  // namespace
}  // namespace ambient
