#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::FreeBody;

FreeBody bodyWithCoupledInertia(Arbitrary& arbitrary) {
  return FreeBody({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
}

// Applies a kick; `x`, wrench and sampled twist as vectors.
Vector6 kicked(const FreeBody& body, const Vector6& x, const Vector6& sampled_twist,
               const Vector6& wrench, double duration) {
  const PairsOf<double> at = plain(pairOfTwist(body.model(), sampled_twist));
  const PairsOf<double> load = plain(pairOfMomentum(body.model(), wrench));
  return asEigen(passiveKick(plain(pairOfTwist(body.model(), x)), at, load, duration).twist);
}

TEST(PassiveKick, NeverGainsEnergyHoweverLongAndStrong) {
  Arbitrary arbitrary(1);
  for (int i = 0; i < 2000; ++i) {
    const FreeBody body = bodyWithCoupledInertia(arbitrary);
    const Vector6 x = arbitrary.twist(10, 10).vector();
    const Vector6 sampled = arbitrary.twist(10, 10).vector();
    const Vector6 load = std::pow(10.0, arbitrary.between(-10, 30)) * arbitrary.twist().vector();
    const double duration = std::pow(10.0, arbitrary.between(-6, 6));
    const Vector6 end = kicked(body, x, sampled, load, duration);
    ASSERT_TRUE(end.allFinite());
    // Rounding of a rotation in the norm of K.
    EXPECT_LE(inertiaNormSquared(body.model(), end),
              inertiaNormSquared(body.model(), x) * (1 + 1e-13));
  }
}

TEST(PassiveKick, IsTheLoadTimesTheTimeAtFirst) {
  Arbitrary arbitrary(2);
  for (int i = 0; i < 100; ++i) {
    const FreeBody body = bodyWithCoupledInertia(arbitrary);
    const Vector6 x = arbitrary.twist().vector();
    Vector6 F = arbitrary.twist().vector();
    if (F.dot(x) > 0) F = -F;  // braking load
    constexpr double kTime = 1e-6;
    const Vector6 change = kicked(body, x, x, F, kTime) - x;
    const Vector6 expected = kTime * (body.model().inverse_inertia * F);
    // Error of second order in time; rates are about |K^-1 F| / |x|, up to some hundred here.
    EXPECT_LT((change - expected).norm(), 1e-3 * expected.norm());
  }
}

TEST(PassiveKick, IsTheExactQuadraticDecayForDragAlone) {
  // m v' = -c v |v|: v = v_0 / (1 + c v_0 t / m).
  Arbitrary arbitrary(3);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const double speed = std::sqrt(inertiaNormSquared(body.model(), x));
  const Vector6 along = 0.7 * x;  // other sampled speed
  const double sampled_speed = 0.7 * speed;
  constexpr double c = 0.3;
  const Vector6 drag = -c * sampled_speed * (body.model().inertia * along);
  for (const double time : {1e-9, 1.0, 1e3, 1e9}) {
    const Vector6 end = kicked(body, x, along, drag, time);
    EXPECT_LT((end - x / (1 + c * speed * time)).norm(), 1e-14 * x.norm()) << time;
  }
}

TEST(PassiveKick, TurnsWithoutLossUnderLiftAlone) {
  // |x| stays constant; x turns in the plane of sample and lift at the rate |a| / |x|.
  Arbitrary arbitrary(4);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Matrix6& K = body.model().inertia;
  const Vector6 x = arbitrary.twist().vector();
  Vector6 lift = arbitrary.twist().vector();
  lift -= x * (x.dot(K * lift) / x.dot(K * x));  // acceleration across the motion
  const double rate = std::sqrt(lift.dot(K * lift) / x.dot(K * x));
  for (const double angle : {0.1, 1.0, 10.0}) {
    const Vector6 end = kicked(body, x, x, K * lift, angle / rate);
    const Vector6 expected = std::cos(angle) * x + std::sin(angle) / rate * lift;
    EXPECT_LT((end - expected).norm(), 1e-13 * x.norm()) << angle;
  }
}

TEST(PassiveKick, OfTwoHalvesIsTheKickOfTheWhole) {
  // Drag and lift, sampled at the present motion in each step: the rule is exact.
  Arbitrary arbitrary(5);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Matrix6& K = body.model().inertia;
  const Vector6 x = arbitrary.twist().vector();
  Vector6 a = arbitrary.twist().vector();
  a -= x * (x.dot(K * a) / x.dot(K * x));
  const Vector6 load = K * (a - 0.4 * x);
  const Vector6 once = kicked(body, x, x, load, 0.8);
  const Vector6 twice = kicked(body, kicked(body, x, x, load, 0.4), x, load, 0.4);
  EXPECT_LT((twice - once).norm(), 1e-14 * x.norm());
}

TEST(PassiveKick, TakesNoPowerFromALoadThatWouldGiveIt) {
  Arbitrary arbitrary(6);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const Vector6 pushing = body.model().inertia * x;
  EXPECT_LT((kicked(body, x, x, pushing, 1.0) - x).norm(), 1e-14 * x.norm());
}

TEST(PassiveKick, LeavesMotionAloneWithoutLoadOrWithoutSample) {
  Arbitrary arbitrary(7);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const Vector6 F = arbitrary.twist().vector();
  const Vector6 zero = Vector6::Zero();
  EXPECT_EQ(kicked(body, x, x, zero, 1e6), x);
  EXPECT_EQ(kicked(body, x, zero, F, 1e6), x);
  EXPECT_EQ(kicked(body, zero, x, F, 1e6), zero);
}

TEST(PassiveKick, DoesNotHideALoadThatIsNotFinite) {
  Arbitrary arbitrary(8);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const Vector6 broken = Vector6::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(kicked(body, x, x, broken, 1.0).allFinite());
}

}  // namespace
}  // namespace ambient
