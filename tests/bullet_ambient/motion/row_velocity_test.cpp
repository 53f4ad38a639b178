#include "bullet_ambient/motion/rows/row_velocity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"

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
      const double share = std::clamp(2 * (1 - row.turn_number), 0.0, 1.0);
      EXPECT_GE(row.turn_number, (1 - 1e-12) * kSpin * step / 0.5);
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

using test::Arbitrary;
using test::FreeBody;

constexpr double kMass = 2;
const Vector3 kMoments(0.3, 0.4, 0.6);

IsotropicResponse isotropicResponse(const Matrix6& inertia) {
  return makeIsotropicResponse(test::inverse(inertia), kMoments.asDiagonal());
}

Matrix6 inMatrix(const IsotropicResponse& even) {
  Matrix6 result = Matrix6::Zero();
  result.topLeftCorner<3, 3>() = even.inverse_inertia;
  result.bottomRightCorner<3, 3>().diagonal().setConstant(even.inverse_mass);
  return result;
}

Matrix6 dryInertia() { return rigidBodyInertia(kMass, kMoments.asDiagonal()); }

TEST(IsotropicResponse, IsThatOfTheDryBodyInAVacuumAndOfAnyEvenInertia) {
  for (const double factor : {1.0, 3.0}) {
    Matrix6 inertia = dryInertia();
    inertia.bottomRightCorner<3, 3>() *= factor;
    const Matrix6 even = inMatrix(isotropicResponse(inertia));
    EXPECT_LT((even * inertia - Matrix6::Identity()).norm(), 1e-14);
  }
}

// K^-1 K' has eigenvalues between 0 and 2: slip decays; docs/theory.md, section 7.
TEST(IsotropicResponse, LetsTheSlipDieOutHoweverUneven) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Arbitrary arbitrary(seed);
    const Matrix6 inertia = dryInertia() + 30 * arbitrary.positiveDefinite();
    const Vector6 values =
        test::generalizedEigenvalues(test::inverse(inertia), inMatrix(isotropicResponse(inertia)));
    EXPECT_GT(values[0], 0) << seed;
    EXPECT_LT(values[5], 2) << seed;
    EXPECT_GE(values[5], 1 - 1e-12) << seed;
  }
}

// k' is along the force, although K turns k aside.
TEST(IsotropicResponse, PutsThePushOfRowsAlongTheForce) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Arbitrary arbitrary(seed);
    FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
    body.state.orientation = Quaternion(arbitrary.rotation());
    body.surroundings.applied.force = arbitrary.vector();
    body.surroundings.gravity.setZero();
    constexpr double kStep = 0.01;
    const RowVelocity row =
        computeRowVelocity({body.model(), body.surroundings, body.settings, kStep}, body.state);
    const Vector6 push = row.change_W.vector() + row.isotropic_excess_W.vector();
    const Vector3 force = body.surroundings.applied.force;
    const double mass = kStep * force.norm() / push.tail<3>().norm();
    EXPECT_LT((mass * push.tail<3>() - kStep * force).norm(), 1e-12 * kStep * force.norm());
    EXPECT_LT(push.head<3>().norm(), 1e-12 * row.change_W.angular.norm());
    EXPECT_GE(mass, body.model().mass);
  }
}

}  // namespace
}  // namespace ambient
