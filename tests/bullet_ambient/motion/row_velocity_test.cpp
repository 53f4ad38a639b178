#include "bullet_ambient/motion/rows/row_velocity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::FreeBody;

RowVelocity rowOf(const FreeBody& body, double step) {
  return computeRowVelocity({body.model(), body.surroundings, body.settings, step}, body.state);
}

Vector6 rowChange(const FreeBody& body, double step) { return rowOf(body, step).change_W.vector(); }

FreeBody spinningBody(unsigned seed, double spin) {
  Arbitrary arbitrary(seed);
  FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
  body.state.orientation = Quaternion(arbitrary.rotation());
  body.state.twist = {spin * arbitrary.vector().normalized(), arbitrary.vector()};
  return body;
}

TEST(RowVelocity, IsTheAccelerationAtTheStartTimesTheStep) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const FreeBody body = spinningBody(seed, 1);
    const Vector6 unit = rowChange(body, 1e-6) / 1e-6;
    EXPECT_LT((rowChange(body, 1e-3) / 1e-3 - unit).norm(), 1e-9 * unit.norm()) << seed;
  }
}

TEST(RowVelocity, HasHalfOfTheTurnUntilItFadesOut) {
  constexpr double kSpin = 10;
  bool has_whole = false, has_part = false, has_none = false;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const FreeBody body = spinningBody(seed, kSpin);
    const Vector6 half = rowOf(body, 1e-9).turning_W.vector() / 1e-9;
    for (const double step : {1e-3, 0.01, 0.02, 0.03, 0.051}) {
      const RowVelocity row = rowOf(body, step);
      const double share = std::clamp(2 * (1 - row.extent), 0.0, 1.0);
      EXPECT_GE(row.extent, (1 - 1e-12) * kSpin * step / 0.5);
      EXPECT_LT((row.turning_W.vector() - share * step * half).norm(), 1e-12 * step * half.norm());
      has_whole |= share == 1;
      has_part |= share > 0 && share < 1;
      has_none |= share == 0;
    }
  }
  EXPECT_TRUE(has_whole && has_part && has_none);
}

TEST(RowVelocity, OfAFastSpinStaysBounded) {
  // Acceleration times step would be |w| dt times the velocity: 17, 170 and 1700.
  for (const double spin : {1e3, 1e4, 1e5}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      const FreeBody body = spinningBody(seed, spin);
      const Vector3 change = rowChange(body, 1.0 / 60).head<3>();
      EXPECT_LT(change.norm(), 10 * spin) << seed;
    }
  }
}

TEST(RowVelocity, CannotBeReversedByDrag) {
  const double radius = 0.1;
  const FluidBody shape = test::gaussSphere(radius);
  FreeBody ball({shape,
                 {1e-3, test::ellipsoidMoments(Vector3::Constant(radius), 1e-3).asDiagonal()},
                 water()});
  ball.state.twist.linear = {0, 0, 100};
  for (const double step : {1e-3, 1.0, 1e6}) {
    const double change = rowChange(ball, step)[5];
    EXPECT_LT(change, 0) << step;
    EXPECT_GT(change, -100) << step;
  }
}

TEST(RowVelocity, CountsItsLoadEvaluation) {
  const FluidBody shape = test::gaussSphere(0.1);
  const FreeBody ball({shape, {1, Matrix3::Identity()}, water()});
  const RowVelocity row =
      computeRowVelocity({ball.model(), ball.surroundings, ball.settings, 0.01}, ball.state);
  EXPECT_EQ(row.count.load_evaluations, 1);
}

}  // namespace
}  // namespace ambient
