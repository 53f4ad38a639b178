#include <gtest/gtest.h>

#include "bullet_ambient/impulse.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"

namespace ambient::test {
namespace {

using Dense6 = Eigen::Matrix<double, 6, 6>;

constexpr int kBodies = 50;
const double kImpulseTolerance = byPrecision(1e-13, 2e-6);

const Medium kFluid{2, 0, Vector3::Zero(), Vector3::Zero()};

// A body of random pose, velocity and coupled inertia in a fluid, and its K, assembled separately.
struct FreeCoupledBody {
  FluidWorld scene;
  btRigidBody* body = nullptr;
  Dense6 K_W;
  Vector3 point;

  explicit FreeCoupledBody(Arbitrary& arbitrary) {
    const Matrix6 added_mass = arbitrary.positiveDefinite();
    BodyDef def{arbitrary.between(0.1, 5),
                Vector3(arbitrary.between(0.5, 1), arbitrary.between(0.5, 1), 0.9)};
    def.start.orientation = Quaternion(arbitrary.rotation());
    def.start.twist = arbitrary.twist();
    body = &scene.add(def, shapeWithoutFaces(added_mass), kFluid);
    Dense6 K = kFluid.density * added_mass;
    K.diagonal() += stack(def.moments, Vector3::Constant(def.mass));
    Dense6 turn = Dense6::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() =
        def.start.orientation.toRotationMatrix();
    K_W = turn * K * turn.transpose();
    point = arbitrary.vector();
  }
  /// Applies an impulse at the point.
  void push(const Vector3& impulse) {
    scene.of(*body).applyImpulse(Wrench::ofForceAt(impulse, point));
  }
  Vector6 velocity() const {
    return stack(toVector3(body->getAngularVelocity()), toVector3(body->getLinearVelocity()));
  }
};

// Solution of K's block of free axes alone, zero along locked axes.
Vector6 lockedResponse(const Dense6& K, const Vector6& free, const Vector6& wrench) {
  Dense6 reduced = free.asDiagonal() * K * free.asDiagonal();
  reduced.diagonal() += Vector6(Vector6::Ones() - free);
  return free.cwiseProduct(Vector6(solve(reduced, free.cwiseProduct(wrench))));
}

TEST(AmbientImpulse, ChangesTheMomentumOfBodyAndFluidByTheImpulse) {
  Arbitrary arbitrary(1);
  for (int i = 0; i < kBodies; ++i) {
    FreeCoupledBody coupled(arbitrary);
    const Vector6 wrench = stack(arbitrary.vector(), arbitrary.vector());
    const Vector6 before = coupled.velocity();
    coupled.scene.of(*coupled.body).applyImpulse(Wrench::fromVector(wrench));
    const Vector6 expected = before + solve(coupled.K_W, wrench);
    EXPECT_LT((coupled.velocity() - expected).norm(),
              10 * kImpulseTolerance * (expected.norm() + before.norm()));
    const Vector6 momentum = coupled.K_W * (coupled.velocity() - before);
    EXPECT_LT((momentum - wrench).norm(),
              10 * kImpulseTolerance * (wrench.norm() + coupled.K_W.norm() * before.norm()));
  }
}

TEST(AmbientImpulse, LockedAxesStayAndTheOthersAnswerWithTheirPartOfK) {
  Arbitrary arbitrary(3);
  for (int i = 0; i < kBodies; ++i) {
    FreeCoupledBody coupled(arbitrary);
    coupled.body->setLinearFactor(btVector3(1, 0, 1));
    coupled.body->setAngularFactor(btVector3(0, 1, 0));
    Vector6 free;
    free << 0, 1, 0, 1, 0, 1;
    const Vector3 impulse = arbitrary.vector();
    const Vector6 before = coupled.velocity();
    coupled.push(impulse);
    const Vector6 change = coupled.velocity() - before;
    const Vector6 expected =
        lockedResponse(coupled.K_W, free, stack(coupled.point.cross(impulse), impulse));
    EXPECT_LT((change - expected).norm(),
              10 * kImpulseTolerance * (expected.norm() + before.norm()));
    EXPECT_EQ((Vector6::Ones() - free).cwiseProduct(change).norm(), 0);
  }
}

TEST(InverseEffectiveMass, IsTheChangeOfThePointsVelocityPerImpulse) {
  Arbitrary arbitrary(4);
  for (int i = 0; i < kBodies; ++i) {
    FreeCoupledBody coupled(arbitrary);
    if (i % 2) coupled.body->setLinearFactor(btVector3(1, 1, 0));
    Fluid& fluid = coupled.scene.fluid;
    const btVector3 point = toBullet(coupled.point);
    const btVector3 impulse = toBullet(arbitrary.vector());
    const btMatrix3x3 inverse_mass = inverseEffectiveMass(fluid, *coupled.body, point);
    const btVector3 before = coupled.body->getVelocityInLocalPoint(point);
    coupled.push(toVector3(impulse));
    const btVector3 change = coupled.body->getVelocityInLocalPoint(point) - before;
    const double scale = static_cast<double>(change.length() + before.length());
    EXPECT_LT(static_cast<double>((inverse_mass * impulse - change).length()),
              20 * kImpulseTolerance * scale);
    EXPECT_EQ(inverse_mass[0][1], inverse_mass[1][0]);
  }
}

TEST(AmbientImpulse, WithoutAFluidIsThatOfStockBullet) {
  Arbitrary arbitrary(5);
  for (int i = 0; i < kBodies; ++i) {
    FreeCoupledBody coupled(arbitrary);
    Fluid& fluid = coupled.scene.fluid;
    btRigidBody& body = *coupled.body;
    fluid.find(body)->setMedium(Medium{});
    btRigidBody stock(body);
    const btVector3 point = toBullet(coupled.point);
    const btVector3 impulse = toBullet(arbitrary.vector());
    const Wrench wrench = Wrench::ofForceAt(toVector3(impulse), coupled.point);
    stock.applyCentralImpulse(impulse);
    stock.applyTorqueImpulse(toBullet(wrench.torque));
    fluid.find(body)->applyImpulse(wrench);
    EXPECT_TRUE(body.getLinearVelocity() == stock.getLinearVelocity());
    EXPECT_TRUE(body.getAngularVelocity() == stock.getAngularVelocity());
    const btVector3 n = impulse.normalized();
    const btScalar expected =
        stock.computeImpulseDenominator(stock.getCenterOfMassPosition() + point, n);
    if (i % 2) fluid.find(body)->remove();
    EXPECT_NEAR(n.dot(inverseEffectiveMass(fluid, body, point) * n), expected,
                10 * kImpulseTolerance * static_cast<double>(expected));
  }
}

TEST(AmbientImpulse, WakesABodyInAFluid) {
  Arbitrary arbitrary(6);
  FreeCoupledBody coupled(arbitrary);
  coupled.body->forceActivationState(ISLAND_SLEEPING);
  coupled.push({1, 0, 0});
  EXPECT_TRUE(coupled.body->isActive());
}

TEST(AmbientImpulse, SeesNewMassProperties) {
  Arbitrary arbitrary(7);
  FreeCoupledBody coupled(arbitrary);
  const btVector3 origin(0, 0, 0);
  coupled.body->setMassProps(btScalar(1e8), btVector3(1, 1, 1) * btScalar(1e8));
  const btMatrix3x3 heavy = inverseEffectiveMass(coupled.scene.fluid, *coupled.body, origin);
  EXPECT_NEAR(heavy[0][0], 1e-8, 1e-14);
}

}  // namespace
}  // namespace ambient::test
