#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"

// Ambient bodies with other features of a world.
namespace ambient::test {
namespace {

BodyDef spinning(double rate) {
  BodyDef def{1, Vector3(0.02, 0.03, 0.04), {}, nullptr};
  def.start.twist = {Vector3(0.1, 0.2, 1).normalized() * rate, Vector3(1, 2, 3)};
  return def;
}

TEST(Interplay, AnotherActionsImpulseSurvives) {
  struct Kick : btActionInterface {
    btRigidBody* body = nullptr;
    void updateAction(btCollisionWorld*, btScalar) override {
      if (body) body->setLinearVelocity(body->getLinearVelocity() + btVector3(0, 0, 1));
      body = nullptr;
    }
    void debugDraw(btIDebugDraw*) override {}
  };
  for (const bool after : {false, true}) {
    FluidWorld scene;
    Kick kick;
    if (!after) scene.removeAction();
    scene.world.addAction(&kick);
    if (!after) scene.addAction();
    btRigidBody& body = scene.add({}, facelessEllipsoid(kUnequalAxes), air());
    kick.body = &body;
    scene.step(1.0 / 60, 2);
    EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().z()), 1, 1e-6);
    scene.world.removeAction(&kick);
  }
}

TEST(Interplay, RotationBeyondBulletsLimitPerStepIsReached) {
  // 100 rad/s at 1/60 s: 95 degrees per step, where Bullet stops at 45.
  FluidWorld scene;
  BodyDef def{1, Vector3::Constant(0.02), {}, nullptr};
  def.start.twist.angular = Vector3(0, 0, 100);
  const btRigidBody& body = scene.add(def, facelessEllipsoid(Vector3::Constant(0.2)), air());
  scene.step(1.0 / 60, 60);
  const Quaternion expected(
      Eigen::AngleAxisd(std::remainder(100.0, 2 * std::acos(-1.0)), Eigen::Vector3d::UnitZ()));
  const double error = 2 * (expected.conjugate() * readState(body).orientation).vec().norm();
  EXPECT_LT(error, byPrecision(1e-11, 2e-4));
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().z()), 100, byPrecision(1e-11, 1e-3));
}

TEST(Interplay, BulletsGyroscopicFlagsChangeNothing) {
  btVector3 velocity[2];
  for (int flag = 0; flag < 2; ++flag) {
    FluidWorld scene;
    btRigidBody& body = scene.add(spinning(20), meshedEllipsoid(kUnequalAxes, 1), air());
    body.setFlags(flag ? BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY : 0);
    scene.step(1.0 / 60, 30);
    velocity[flag] = body.getAngularVelocity();
  }
  EXPECT_TRUE(velocity[0] == velocity[1]);
}

TEST(Interplay, SameInputGivesTheSameBitsInAnyOrderOfAttachment) {
  btVector3 position[2];
  for (int order = 0; order < 2; ++order) {
    FluidWorld scene;
    const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
    BodyDef other = spinning(5);
    other.start.position = Vector3(100, 0, 0);
    if (order == 1) scene.add(other, shape, water());
    const btRigidBody& body = scene.add(spinning(20), shape, air());
    if (order == 0) scene.add(other, shape, water());
    scene.step(1.0 / 60, 60);
    position[order] = body.getWorldTransform().getOrigin();
  }
  EXPECT_TRUE(position[0] == position[1]);
}

TEST(Interplay, NewMassPropertiesAreSeen) {
  FluidWorld scene;
  btRigidBody& body = scene.add({}, facelessEllipsoid(kUnequalAxes), air());
  scene.step(1.0 / 60);
  const btVector3 moments(4, 5, 6);
  body.setMassProps(3, moments);
  body.updateInertiaTensor();
  body.applyCentralForce({1, 0, 0});
  scene.step(1.0 / 60);
  const double K = 3 + air().density * facelessEllipsoid(kUnequalAxes).added_mass(3, 3);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()) * 60 * K, 1,
              byPrecision(1e-12, 1e-5));
}

TEST(Interplay, AJumpFromAirToWaterKeepsTheVelocityAndChangesTheInertia) {
  FluidWorld scene;
  btRigidBody& body = scene.add(spinning(0), facelessEllipsoid(kUnequalAxes), air());
  scene.step(1.0 / 60);
  const btVector3 before = body.getLinearVelocity();
  scene.of(body).setMedium(water());
  EXPECT_TRUE(body.getLinearVelocity() == before);
  EXPECT_NEAR(scene.of(body).inertia()(5, 5),
              1 + water().density * facelessEllipsoid(kUnequalAxes).added_mass(5, 5), 1e-6);
}

TEST(Interplay, DriftingBodyStaysAwakeAndRestingBodySleeps) {
  for (const double speed : {0.5, 0.05, 0.0}) {
    FluidWorld scene;
    BodyDef def{1, Vector3::Constant(0.02), {}, nullptr};
    def.start.twist.linear = Vector3(speed, 0, 0);
    btRigidBody& body = scene.add(def, facelessEllipsoid(kUnequalAxes), air());
    body.forceActivationState(ACTIVE_TAG);
    scene.step(1.0 / 60, 600);
    EXPECT_EQ(body.isActive(), speed > 0) << speed << " m/s";
    EXPECT_NEAR(static_cast<double>(body.getWorldTransform().getOrigin().x()), 10 * speed,
                1e-3 * speed);
  }
}

TEST(Interplay, NonFiniteVelocityDoesNotSpread) {
  FluidWorld scene;
  std::vector<std::string> said;
  scene.fluid.setReport([&](const std::string& text) { said.push_back(text); });
  const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  const btRigidBody& healthy = scene.add(spinning(3), shape, air());
  BodyDef far = spinning(3);
  far.start.position = Vector3(50, 0, 0);
  btRigidBody& sick = scene.add(far, shape, air());
  sick.applyCentralForce({std::numeric_limits<btScalar>::infinity(), 0, 0});
  scene.step(1.0 / 60, 3);
  EXPECT_TRUE(readState(healthy).isFinite());
  EXPECT_TRUE(readState(sick).isFinite());  // the step that was not finite is not taken over
  EXPECT_GT(scene.of(sick).counters().rejected, 0);
  EXPECT_EQ(scene.of(healthy).counters().rejected, 0);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("not finite"), std::string::npos);
}

TEST(Interplay, ASolverOfAnotherWorldsFluidIsReportedOnce) {
  FluidWorld scene, other;
  std::vector<std::string> said;
  scene.fluid.setReport([&](const std::string& text) { said.push_back(text); });
  const auto solver = makeSolver<btSequentialImpulseConstraintSolver>(scene.fluid);
  other.world.setConstraintSolver(solver.get());
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1));
  def.medium = air();
  scene.fluid.add(other.add(spinning(3)), def);
  other.step(1.0 / 60, 5);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("in another world"), std::string::npos);
}

TEST(Interplay, AMissingSolverIsReportedOnce) {
  FluidWorld scene;
  btSequentialImpulseConstraintSolver stock;
  scene.world.setConstraintSolver(&stock);
  std::vector<std::string> said;
  scene.fluid.setReport([&](const std::string& text) { said.push_back(text); });
  scene.add(spinning(3), meshedEllipsoid(kUnequalAxes, 1), air());
  scene.step(1.0 / 60, 5);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("setConstraintSolver"), std::string::npos);
}

TEST(Interplay, ABodyLeavesTheWorldAndComesBack) {
  FluidWorld scene;
  btRigidBody& body = scene.add(spinning(10), meshedEllipsoid(kUnequalAxes, 1), air());
  scene.step(1.0 / 60, 10);
  scene.world.removeRigidBody(&body);
  const btVector3 held = body.getWorldTransform().getOrigin();
  scene.step(1.0 / 60, 10);
  EXPECT_TRUE(body.getWorldTransform().getOrigin() == held);
  scene.world.addRigidBody(&body);
  scene.step(1.0 / 60, 10);
  EXPECT_GT((body.getWorldTransform().getOrigin() - held).length(), btScalar(0.1));
}

}  // namespace
}  // namespace ambient::test
