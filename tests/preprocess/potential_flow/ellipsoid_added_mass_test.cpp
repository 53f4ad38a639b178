#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"

namespace ambient {
namespace {

// Lamb's formulae with Carlson's integrals from another library, checked by quadrature.
TEST(EllipsoidAddedMass, AgreesWithPublishedNumbers) {
  Vector6 three_axes, flat, long_one;
  three_axes << 9.632557631369707, 35.599830507687976, 3.914191474995723, 4.6560012697568816,
      9.161970906562738, 34.21891765849272;
  flat << 0.35465227988364084, 0.35465227988364084, 0, 0.0003273857431984761, 0.0003273857431984761,
      2.658763969103372;
  long_one << 0, 2.0057929172153712, 2.0057929172153712, 1.759417960022179, 5.899579467820822,
      5.899579467820822;
  EXPECT_LT((ellipsoidAddedMass({3, 2, 1}) - three_axes).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((ellipsoidAddedMass({1, 1, 0.01}) - flat).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((ellipsoidAddedMass({2, 1, 1}) - long_one).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(EllipsoidAddedMass, BallHasHalfItsVolume) {
  const Vector6 ball = ellipsoidAddedMass({0.5, 0.5, 0.5});
  EXPECT_EQ(Vector3(ball.head<3>()), Vector3::Zero());
  for (int k = 3; k < 6; ++k) EXPECT_NEAR(ball[k] / (kPi / 12), 1, 1e-15);
}

TEST(EllipsoidAddedMass, AlmostABallHasAlmostNoRotation) {
  const double e = 1e-6, volume = 4 * kPi / 3;
  const Vector6 K = ellipsoidAddedMass({1, 1, 1 + e});
  // Limit for alpha_0 - gamma_0 = 4/5 e: V/5 (2 e)^2 / 3. The next term is smaller by e.
  EXPECT_NEAR(K[0] / (4.0 / 15 * volume * e * e), 1, 1e-5);
  EXPECT_EQ(K[2], 0);
}

TEST(EllipsoidAddedMass, SizeScales) {
  const Vector6 small = ellipsoidAddedMass({3e-4, 2e-4, 1e-4}),
                large = ellipsoidAddedMass({3, 2, 1});
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(small[k] / large[k], 1e-20, 1e-33);
    EXPECT_NEAR(small[3 + k] / large[3 + k], 1e-12, 1e-25);
  }
}

TEST(EllipsoidAddedMass, IsTheLimitOfTheSolver) {
  const Vector3 axes(1, 0.7, 0.4);
  const Matrix6 solved =
      test::addedMassOf(makeEllipsoidMesh(axes, 1300), 4 * kPi / 3 * axes.prod());
  EXPECT_LT(test::differenceOf(solved, ellipsoidAddedMass(axes).asDiagonal()), 1e-3);
}

}  // namespace
}  // namespace ambient
