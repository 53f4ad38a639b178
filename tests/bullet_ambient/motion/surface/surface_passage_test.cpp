#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/passage_kernel.h"
#include "bullet_ambient/motion/surface/symmetric_matrix.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

constexpr double kHuge = 1e30;  // gravity; Froude number of any entry: 0

/// Change of inertia in a passage.
struct Change {
  Change(const Matrix6& from, const Matrix6& to)
      : before(from), after(to), inverse(Matrix6(test::inverse(to))) {}

  SymmetricMatrix before, after, inverse;
};

BoundedTwist passed(const PassageOf<double>& passage, const Vector6& x) {
  const PassedOf<double> end = passSurface(passage, plain(x));
  return {asEigen(end.twist), end.energy_removed};
}

/// Speed of a falling body of 1 kg at depth 1, added mass d^2 along z at depth d. Steps are equal
/// in depth, so unequal in time.
double speedAfterEntry(double gravity, double start, int steps) {
  double speed = start;
  const double step = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double from = i * step, to = from + step, duration = step / speed;
    const auto inertiaAt = [](double depth) {
      Matrix6 K = Matrix6::Identity();
      K(5, 5) += depth * depth;
      return K;
    };
    const Change K(inertiaAt(from), inertiaAt(to));
    Vector6 x = Vector6::Zero();
    x[5] = -speed;
    const double by_height = 0.5 * 2 * from * speed * speed;
    const PassageOf<double> passage{
        K.before, K.after, K.inverse, {{0, 0, 0}, {0, 0, -by_height}}, {0, 0, 1}, {0, 0, 0}, to,
        to - 10,  gravity, duration};
    speed = -passed(passage, x).twist[5];
  }
  return speed;
}

TEST(SurfacePassage, KeepsMomentumWhereItIsFastAndEnergyWhereItIsSlow) {
  // (m + K) v = m v_0 with K = 1 at the end; without inertia forces (m + K) v^2 = m v_0^2.
  EXPECT_NEAR(speedAfterEntry(0, 2, 100), 1, 1e-12);
  EXPECT_NEAR(speedAfterEntry(kHuge, 2, 100), std::sqrt(2), 2e-2);
  EXPECT_NEAR(speedAfterEntry(kHuge, 2, 1000), std::sqrt(2), 2e-3);
}

// At a Froude number of infinity all momentum of a body that sinks goes into spray: the force that
// returns it acts at the centre of buoyancy, eq. (67).
TEST(SurfacePassage, SprayTakesMomentumAtTheCentreOfBuoyancy) {
  const Matrix6 before = Matrix6::Identity();
  Matrix6 after = before;
  after(5, 5) = 1.1;
  const Change K(before, after);
  Vector6 x = Vector6::Zero();
  x[5] = -2;
  const PassageOf<double> passage{K.before,  K.after,     K.inverse, {{0, 0, 0}, {0, 0, -10}},
                                  {0, 0, 1}, {0.3, 0, 0}, 1,         -9,
                                  0,         0.01};
  Vector6 change = Vector6::Zero();  // c x n dt 10 N
  change[1] = -0.03;
  EXPECT_LT((after * passed(passage, x).twist - before * x - change).norm(), 1e-15);
}

TEST(SurfacePassage, NeverAddsEnergyWhateverChanges) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 300; ++i) {
    const Matrix6 before = arbitrary.positiveDefinite(), after = arbitrary.positiveDefinite();
    const Change K(before, after);
    const Vector6 x = arbitrary.twist().vector();
    const PassageOf<double> passage{K.before,
                                    K.after,
                                    K.inverse,
                                    plain(arbitrary.twist(10, 10).vector()),
                                    plain(Vector3(arbitrary.vector().normalized())),
                                    plain(arbitrary.vector()),
                                    arbitrary.between(-1, 1),
                                    arbitrary.between(-1, 1),
                                    arbitrary.between(0, 10),
                                    arbitrary.between(0, 1)};
    const Vector6 end = passed(passage, x).twist;
    EXPECT_LE(end.dot(after * end), x.dot(before * x) * (1 + 1e-12));
  }
}

// Without gradient the momentum is conserved: K_1^-1 K_0 x, except for the bound.
TEST(SurfacePassage, TellsTheEnergyThatItRemoves) {
  test::Arbitrary arbitrary(3);
  for (int i = 0; i < 100; ++i) {
    const Matrix6 before = arbitrary.positiveDefinite();
    const Matrix6 after = (i % 2 == 0 ? 0.5 : 1.5) * before;
    const Matrix6 inverse = test::inverse(after);
    const Vector6 x = arbitrary.twist().vector(), end = inverse * (before * x);
    const double had = x.dot(before * x) / 2, gain = end.dot(after * end) / 2 - had;
    EXPECT_EQ(gain > 0, i % 2 == 0);
    const Change K(before, after);
    const PassageOf<double> passage{K.before,  K.after,   K.inverse, {{0, 0, 0}, {0, 0, 0}},
                                    {0, 0, 1}, {0, 0, 0}, 1,         1,
                                    9.81,      0.01};
    EXPECT_NEAR(passed(passage, x).energy_removed, std::max(0.0, gain), 1e-11 * had) << i;
  }
}

TEST(SurfacePassage, LeavesABodyAloneWhoseInertiaStays) {
  test::Arbitrary arbitrary(2);
  const Matrix6 inertia = arbitrary.positiveDefinite();
  const Change K(inertia, inertia);
  const Vector6 x = arbitrary.twist().vector();
  const PassageOf<double> passage{
      K.before, K.after, K.inverse, {{1, 2, 3}, {4, 5, 6}}, {0, 0, 1}, {0, 0, 0}, 1, 1, 9.81, 0.01};
  EXPECT_EQ(passed(passage, x).twist, x);
  EXPECT_EQ(passed(passage, x).energy_removed, 0);
}

}  // namespace
}  // namespace ambient
