#include "bullet_ambient/force/law/passivity_guard.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/bodies/random_bodies.h"

namespace ambient::passivity_guard {
namespace {

constexpr double kRounding = 1e-13;

TEST(PassivityGuard, LeavesALoadThatBrakesAsItIs) {
  test::Arbitrary arbitrary(51);
  for (int i = 0; i < 1000; ++i) {
    const Twist x = arbitrary.twist();
    Wrench f{arbitrary.vector(), arbitrary.vector()};
    if (power(f, x) > 0) f = -1 * f;
    const SurfaceLoad guarded = removePositivePower(f, x, arbitrary.positiveDefinite());
    EXPECT_FALSE(guarded.guarded);
    EXPECT_EQ(guarded.wrench.vector(), f.vector());
  }
}

TEST(PassivityGuard, TakesExactlyThePowerAway) {
  test::Arbitrary arbitrary(52);
  for (int i = 0; i < 1000; ++i) {
    const Twist x = arbitrary.twist();
    Wrench f{arbitrary.vector(), arbitrary.vector()};
    if (power(f, x) < 0) f = -1 * f;
    const Matrix6 K = arbitrary.positiveDefinite();
    const SurfaceLoad guarded = removePositivePower(f, x, K);
    EXPECT_TRUE(guarded.guarded);
    EXPECT_NEAR(power(guarded.wrench, x), 0,
                kRounding * guarded.wrench.vector().norm() * x.vector().norm());
    const Vector6 expected =
        f.vector() - power(f, x) / x.vector().dot(K * x.vector()) * (K * x.vector());
    EXPECT_LT((guarded.wrench.vector() - expected).norm(), kRounding * expected.norm());
  }
}

TEST(PassivityGuard, TakesTheLoadAwayAlongTheMomentumOnly) {
  test::Arbitrary arbitrary(53);
  const Twist x = arbitrary.twist();
  const Matrix6 K = arbitrary.positiveDefinite();
  const Wrench f = Wrench::fromVector(K * x.vector() + arbitrary.twist(0.1, 0.1).vector());
  const SurfaceLoad guarded = removePositivePower(f, x, K);
  ASSERT_TRUE(guarded.guarded);
  // Expects an acceleration along the motion: K^-1 K x = x.
  const Vector6 change = guarded.wrench.vector() - f.vector();
  const Vector6 direction = (K * x.vector()).normalized();
  EXPECT_LT((change - direction * direction.dot(change)).norm(), kRounding * f.vector().norm());
}

TEST(PassivityGuard, DoesNotDependOnTheSizeOfTheMotion) {
  test::Arbitrary arbitrary(54);
  const Twist x = arbitrary.twist();
  const Matrix6 K = arbitrary.positiveDefinite();
  const Wrench f = Wrench::fromVector(K * x.vector());
  const Vector6 expected = removePositivePower(f, x, K).wrench.vector();
  for (const double size : {0x1p-1000, 0x1p-300, 0x1p300, 0x1p1000}) {
    const SurfaceLoad guarded = removePositivePower(f, {size * x.angular, size * x.linear}, K);
    EXPECT_TRUE(guarded.guarded) << size;
    EXPECT_EQ(guarded.wrench.vector(), expected) << size;
  }
}

TEST(PassivityGuard, LeavesTheLoadOfABodyAtRestAsItIs) {
  test::Arbitrary arbitrary(55);
  const Wrench f{arbitrary.vector(), arbitrary.vector()};
  const SurfaceLoad guarded = removePositivePower(f, Twist{}, arbitrary.positiveDefinite());
  EXPECT_FALSE(guarded.guarded);
  EXPECT_EQ(guarded.wrench.vector(), f.vector());
}

TEST(PassivityGuard, LeavesWhatIsNotFiniteToTheCaller) {
  test::Arbitrary arbitrary(56);
  const Matrix6 K = arbitrary.positiveDefinite();
  const Twist x = arbitrary.twist();
  const Wrench f = Wrench::fromVector(K * x.vector());
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(removePositivePower(f, {Vector3::Constant(bad), x.linear}, K).guarded);
    EXPECT_FALSE(removePositivePower({f.torque, Vector3::Constant(bad)}, x, K).guarded);
  }
}

}  // namespace
}  // namespace ambient::passivity_guard
