#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "tests/bullet_ambient/bullet/contact/uneven_body.h"
#include "tests/support/matrices.h"

// Corrections by the fluid's action after rows have moved a body, and motions without any.
namespace ambient::test {
namespace {

class OtherAction : public btActionInterface {
 public:
  explicit OtherAction(std::function<void()> act) : act_(std::move(act)) {}
  void updateAction(btCollisionWorld*, btScalar) override { act_(); }
  void debugDraw(btIDebugDraw*) override {}

 private:
  std::function<void()> act_;
};

// A body on a ball joint, with another action before or after the fluid's.
class Held {
 public:
  explicit Held(double spin) {
    Arbitrary arbitrary(3);
    BodyDef def = unevenBody();
    const Vector3 axis = arbitrary.vector().normalized();
    def.start.twist = {spin * axis, spin * kPivot.cross(axis)};
    body = &scene.add(def, unevenFluid(arbitrary, 3), idealFluid(1));
    scene.contents.take(std::make_unique<btPoint2PointConstraint>(*body, toBullet(kPivot)));
  }

  /// Velocities after one step with the other action `act`.
  Vector6 after(std::function<void()> act, bool is_first) {
    OtherAction other(std::move(act));
    if (is_first) scene.removeAction();
    scene.world.addAction(&other);
    if (is_first) scene.addAction();
    scene.step(1.0 / 60);
    scene.world.removeAction(&other);
    return stack(toVector3(body->getAngularVelocity()), toVector3(body->getLinearVelocity()));
  }

  static inline const Vector3 kPivot{0.5, 0, 0};
  FluidWorld scene;
  btRigidBody* body;
};

TEST(RowMotion, LeavesImpulsesOfOtherActionsWhole) {
  const btVector3 push(2, 0, 2);
  for (const double spin : {1, 30, 40, 60, 100, 150, 200, 300}) {
    const Vector6 alone = Held(spin).after([] {}, true);
    for (const bool is_first : {true, false}) {
      Held held(spin);
      const Vector6 pushed = held.after(
          [&] { held.body->setLinearVelocity(held.body->getLinearVelocity() + push); }, is_first);
      const Vector6 change = pushed - alone - stack(Vector3::Zero(), toVector3(push));
      EXPECT_LT(change.norm(), byPrecision(1e-13, 1e-5) * (1 + alone.norm())) << spin;
    }
  }
}

Vector6 turnedBy(const Quaternion& q, const Vector6& x) {
  return stack(q * Vector3(x.head<3>()), q * Vector3(x.tail<3>()));
}

// Above turns of 0.5 rad rows ignore the turning part. The momentum follows from the
// velocity of Bullet's move, eq. (31). Its energy in the next pose may exceed eq.
// (31a).
TEST(RowMotion, CountsTheEnergyThatItsBoundRemoves) {
  constexpr double kStep = 1.0 / 60;
  int bounded = 0;
  for (const double spin : {40, 60, 100, 200}) {
    Held held(spin);
    const Fluid& fluid = held.scene.fluid;
    const Matrix6 K = fluid.find(*held.body)->inertia();
    for (int step = 0; step < 20; ++step) {
      const Quaternion from = readState(*held.body).orientation;
      const double removed_before = fluid.find(*held.body)->counters().energy_removed;
      Vector6 moved_W, by_momentum;  // the latter in B
      held.after(
          [&] {
            const RigidState now = readState(*held.body);
            moved_W = turnedBy(now.orientation, now.twist.vector());
            Vector6 momentum_W = turnedBy(from, K * turnedBy(from.conjugate(), moved_W));
            const Vector3 way = kStep * moved_W.tail<3>(), linear = momentum_W.tail<3>();
            momentum_W.head<3>() -= way.cross(linear);
            by_momentum = solve(K, turnedBy(now.orientation.conjugate(), momentum_W));
          },
          true);
      if (kStep * moved_W.head<3>().norm() < 0.5) break;
      const Vector6 end = readState(*held.body).twist.vector();
      const double has = end.dot(K * end) / 2, gain = by_momentum.dot(K * by_momentum) / 2 - has;
      const double removed = fluid.find(*held.body)->counters().energy_removed - removed_before;
      EXPECT_NEAR(removed, std::max(0.0, gain), byPrecision(1e-12, 1e-4) * has)
          << spin << " rad/s, step " << step;
      bounded += gain > 0.01 * has;
    }
  }
  EXPECT_GT(bounded, 3);
}

TEST(RowMotion, IsNotBoundedInSmallTurns) {
  Held held(1);
  for (int step = 0; step < 20; ++step) held.after([] {}, true);
  EXPECT_EQ(held.scene.of(*held.body).counters().energy_removed, 0);
}

TEST(RowMotion, LeavesABodyAloneThatAnActionHasPutElsewhere) {
  const btQuaternion turned(btVector3(0, 0, 1), bt(1));
  const btVector3 elsewhere(3, 2, 1);
  for (const bool is_moved : {true, false}) {
    Held held(1);
    btVector3 before;
    const Vector6 left = held.after(
        [&] {
          before = held.body->getLinearVelocity();
          btTransform pose = held.body->getWorldTransform();
          if (is_moved) pose.setOrigin(elsewhere);
          if (!is_moved) pose.setRotation(turned);
          held.body->setCenterOfMassTransform(pose);
        },
        true);
    EXPECT_EQ(Vector3(left.tail<3>()), toVector3(before));
  }
}

// A motor drives a ball on a rail against a thin wall; continuous collision stops it within the
// step. The rail's impulse alone changes the momentum about a fixed place.
TEST(RowMotion, KeepsTheMomentumOfABodyThatIsStoppedOnItsWay) {
  constexpr double kLong = 1.0 / 60, kSpeed = -3, kGap = 0.03;
  Arbitrary arbitrary(5);
  FluidWorld scene;
  btSphereShape ball(bt(0.01));
  BodyDef def = unevenBody();
  def.shape = &ball;
  def.start.twist.angular = {3, 1, 2};
  btRigidBody& body = scene.add(def, unevenFluid(arbitrary, 2), idealFluid(1));
  body.setCcdMotionThreshold(bt(0.01));
  body.setCcdSweptSphereRadius(bt(0.01));
  btBoxShape thin({bt(0.005), 1, 1});
  btRigidBody wall(0, nullptr, &thin);
  wall.setWorldTransform(btTransform(btQuaternion::getIdentity(), {bt(kGap), 0, 0}));
  scene.world.addRigidBody(&wall);
  btGeneric6DofSpring2Constraint rail(body, btTransform::getIdentity());
  rail.setLinearLowerLimit({1, 0, 0});
  rail.setLinearUpperLimit({-1, 0, 0});
  for (int axis : {3, 4, 5}) rail.setLimit(axis, 1, -1);
  rail.enableMotor(0, true);
  rail.setTargetVelocity(0, bt(kSpeed));
  rail.setMaxMotorForce(0, bt(1e6));
  btJointFeedback feedback;
  rail.setJointFeedback(&feedback);
  scene.world.addConstraint(&rail);

  const Momentum before = worldMomentum(scene, body);
  scene.step(kLong);
  const Momentum after = worldMomentum(scene, body);
  const auto way = static_cast<double>(body.getWorldTransform().getOrigin().x());
  EXPECT_GT(way, 0.2 * kGap);
  EXPECT_LT(way, kGap);
  // Starting point: the origin.
  const Vector3 torque = kLong * toVector3(feedback.m_appliedTorqueBodyB);
  const Vector3 force = kLong * toVector3(feedback.m_appliedForceBodyB);
  const double tolerance = byPrecision(1e-12, 1e-5) * force.norm();
  EXPECT_GT(force.norm(), 1);
  EXPECT_LT((after.linear - before.linear - force).norm(), tolerance);
  EXPECT_LT((after.angular - before.angular - torque).norm(), tolerance);
  scene.world.removeConstraint(&rail);
  scene.world.removeRigidBody(&wall);
}

}  // namespace
}  // namespace ambient::test
