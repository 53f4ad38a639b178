#include <gtest/gtest.h>

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::FreeBody;

constexpr double kMass = 2;
const Vector3 kMoments(0.3, 0.4, 0.6);

EvenResponse evenResponse(const Matrix6& inertia) {
  return makeEvenResponse(test::inverse(inertia), kMoments.asDiagonal());
}

Matrix6 inMatrix(const EvenResponse& even) {
  Matrix6 result = Matrix6::Zero();
  result.topLeftCorner<3, 3>() = even.inverse_inertia;
  result.bottomRightCorner<3, 3>().diagonal().setConstant(even.inverse_mass);
  return result;
}

Matrix6 dryInertia() { return rigidBodyInertia(kMass, kMoments.asDiagonal()); }

TEST(EvenResponse, IsThatOfTheDryBodyInAVacuumAndOfAnyEvenInertia) {
  for (const double factor : {1.0, 3.0}) {
    Matrix6 inertia = dryInertia();
    inertia.bottomRightCorner<3, 3>() *= factor;
    const Matrix6 even = inMatrix(evenResponse(inertia));
    EXPECT_LT((even * inertia - Matrix6::Identity()).norm(), 1e-14);
  }
}

// K^-1 K' has eigenvalues between 0 and 2: slip decays; docs/theory.md, section 7.
TEST(EvenResponse, LetsTheSlipDieOutHoweverUneven) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Arbitrary arbitrary(seed);
    const Matrix6 inertia = dryInertia() + 30 * arbitrary.positiveDefinite();
    const Vector6 values =
        test::generalizedEigenvalues(test::inverse(inertia), inMatrix(evenResponse(inertia)));
    EXPECT_GT(values[0], 0) << seed;
    EXPECT_LT(values[5], 2) << seed;
    EXPECT_GE(values[5], 1 - 1e-12) << seed;
  }
}

// k' is along the force, although K turns k aside.
TEST(EvenResponse, PutsThePushOfRowsAlongTheForce) {
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
