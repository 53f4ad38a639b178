#include <gtest/gtest.h>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/rotations.h"

// Bullet's features for rigid bodies, used on ambient bodies.
namespace ambient::test {
namespace {

double speedAlongX(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().x());
}
TEST(Features, GravityOfASingleBodyMakesItsWeightAndBuoyancy) {
  const FluidBody shape = facelessEllipsoid(kUnequalAxes);
  const double mass = 2 * shape.volume * 1000;
  const Vector3 down(1, -2, -5);
  FluidWorld scene;
  BodyDef def;
  def.mass = mass;
  btRigidBody& own = scene.add(def, shape, idealFluid(1000));
  def.start.position = {10, 0, 0};
  const btRigidBody& other = scene.add(def, shape, idealFluid(1000));
  own.setGravity(toBullet(down));
  scene.step(1.0 / 64);
  // Half of the weight is buoyancy; every axis has its own total inertia.
  const Vector3 inertia = scene.of(own).inertia().diagonal().tail<3>();
  const Vector3 expected = (mass / 2 * down / 64).cwiseQuotient(inertia);
  EXPECT_LT((toVector3(own.getLinearVelocity()) - expected).norm(), byPrecision(1e-4, 1e-4));
  EXPECT_TRUE(other.getLinearVelocity() == btVector3(0, 0, 0));
}

TEST(Features, ABodyThatIgnoresTheWorldsGravityIsNotLifted) {
  FluidWorld scene;
  btRigidBody& body = scene.add({}, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  scene.world.removeRigidBody(&body);
  body.setFlags(body.getFlags() | BT_DISABLE_WORLD_GRAVITY);
  scene.world.setGravity({0, 0, bt(-9.81)});
  scene.world.addRigidBody(&body);
  scene.step(1.0 / 64, 10);
  EXPECT_TRUE(body.getLinearVelocity() == btVector3(0, 0, 0));
}

struct Place : btMotionState {
  btTransform now = btTransform::getIdentity();
  void getWorldTransform(btTransform& transform) const override { transform = now; }
  void setWorldTransform(const btTransform& transform) override { now = transform; }
};

// Pose by motion state after calls of `call_step`, with fixed substeps of 1/64 s.
btTransform motionStateAfter(double call_step, int calls) {
  FluidWorld scene;
  Place place;
  BodyDef def{1, Vector3::Ones(), startWith({Vector3(0, 0, 3), Vector3(1, 0, 0)})};
  // Makes a curved path: the added mass across is twice the one along.
  Matrix6 added = Matrix6::Identity();
  added(4, 4) = 3;
  btRigidBody& body = scene.add(def, shapeWithoutFaces(added, 0), idealFluid(1));
  body.setMotionState(&place);
  for (int i = 0; i < calls; ++i) scene.world.stepSimulation(bt(call_step), 10, bt(1.0 / 64));
  body.setMotionState(nullptr);
  return place.now;
}

TEST(Features, MotionStatesAreInterpolatedBetweenSubsteps) {
  // Bullet interpolates one substep late, after the time t + 1/64 s. For t half way between two
  // substeps the pose must lie half way between theirs.
  const btTransform before = motionStateAfter(1.0 / 64, 10);
  const btTransform after = motionStateAfter(1.0 / 64, 11);
  const btTransform between = motionStateAfter(1.0 / 128, 21);
  const btVector3 middle = (before.getOrigin() + after.getOrigin()) / 2;
  EXPECT_LT(static_cast<double>((between.getOrigin() - middle).length()), byPrecision(1e-12, 1e-6));
  const double turn =
      angleBetween(toQuaternion(before.getRotation()), toQuaternion(between.getRotation()));
  const double whole =
      angleBetween(toQuaternion(before.getRotation()), toQuaternion(after.getRotation()));
  EXPECT_NEAR(turn, whole / 2, byPrecision(1e-12, 1e-6));
  EXPECT_GT(whole, 0.03);
}

TEST(Features, ADetachedBodyFliesOnAsInAVacuum) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-10)});
  btRigidBody& body = scene.add({}, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  scene.step(1.0 / 64, 5);
  const double before = static_cast<double>(body.getLinearVelocity().z());
  EXPECT_GT(before, 0);  // it rises
  EXPECT_TRUE(scene.of(body).remove());
  scene.step(1.0 / 64);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().z()) - before, -10.0 / 64, 1e-6);
}

// Bullet has already moved the body by the mean velocity of its flight, set by the solver.
TEST(Features, ABodyDetachedBetweenSolverAndActionKeepsTheMeanVelocityOfItsFlight) {
  const double dt = 1.0 / 64;
  FluidWorld scene, attached;
  BodyDef def{1, Vector3::Ones(), startWith({Vector3::Zero(), {1, 2, 3}})};
  btRigidBody& body = scene.add(def, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  const btRigidBody& twin = attached.add(def, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  const OtherAction detach(scene, [&] {
    if (const auto found = scene.fluid.find(body)) found->remove();
  });
  scene.step(dt);
  attached.step(dt);
  EXPECT_EQ(scene.fluid.size(), 0u);
  const Vector3 way = toVector3(body.getWorldTransform().getOrigin());
  EXPECT_EQ(way, toVector3(twin.getWorldTransform().getOrigin()));
  const Vector3 velocity = toVector3(body.getLinearVelocity());
  EXPECT_LT((velocity - way / dt).norm(), byPrecision(1e-12, 1e-5));
  EXPECT_GT((velocity - toVector3(twin.getLinearVelocity())).norm(), 0.01) << "of the flight's end";
  scene.step(dt, 2);
  EXPECT_EQ(toVector3(body.getLinearVelocity()), velocity);
}

TEST(Features, ABodyMadeKinematicIsLeftToBullet) {
  FluidWorld scene;
  btRigidBody& body = scene.add({1, Vector3::Ones(), startWith({Vector3::Zero(), {1, 0, 0}})},
                                meshedEllipsoid(kUnequalAxes, 1), water());
  scene.step(1.0 / 64);
  scene.world.removeRigidBody(&body);
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  scene.world.addRigidBody(&body);
  const long long evaluations = scene.of(body).counters().load_evaluations;
  const btVector3 place = body.getWorldTransform().getOrigin();
  scene.step(1.0 / 64, 5);
  EXPECT_EQ(scene.of(body).counters().load_evaluations, evaluations);
  EXPECT_TRUE(body.getWorldTransform().getOrigin() == place);
}

TEST(Features, AMassOfZeroIsLeftToBulletUntilItIsPositiveAgain) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-10)});
  btRigidBody& body = scene.add({}, facelessEllipsoid(kUnequalAxes), idealFluid(1));
  scene.step(1.0 / 64);
  body.setMassProps(0, {0, 0, 0});
  scene.step(1.0 / 64, 3);
  body.setMassProps(2, {1, 1, 1});
  body.updateInertiaTensor();
  scene.step(1.0 / 64);
  EXPECT_NEAR(scene.of(body).inertia()(0, 0), 1, 0.1);
  EXPECT_NEAR(scene.of(body).inertia()(5, 5), 2 + facelessEllipsoid(kUnequalAxes).added_mass(5, 5),
              1e-6);
}

TEST(Features, TheMediumMayChangeInEveryStep) {
  // Sets the same gust in each step: must move like a body with a gust set once.
  Medium wind = air();
  wind.velocity = {5, 0, 0};
  FluidWorld once, anew;
  const btRigidBody& a = once.add({}, meshedEllipsoid(kUnequalAxes, 1), wind);
  const btRigidBody& b = anew.add({}, meshedEllipsoid(kUnequalAxes, 1), wind);
  for (int i = 0; i < 60; ++i) {
    anew.of(b).setMedium(wind);
    once.step(1.0 / 60);
    anew.step(1.0 / 60);
  }
  EXPECT_GT(speedAlongX(a), 0);
  EXPECT_TRUE(a.getWorldTransform() == b.getWorldTransform());
  EXPECT_TRUE(a.getLinearVelocity() == b.getLinearVelocity());
  // The history of the loads is kept: no extra evaluation in each step.
  EXPECT_EQ(anew.of(b).counters().load_evaluations, once.of(a).counters().load_evaluations);
}

BodyDef spinning(double rate) {
  return {1, Vector3(0.02, 0.03, 0.04),
          startWith({Vector3(0.1, 0.2, 1).normalized() * rate, Vector3(1, 2, 3)})};
}

TEST(Features, AnotherActionsImpulseSurvives) {
  for (const bool after : {false, true}) {
    FluidWorld scene;
    btRigidBody& body = scene.add({}, facelessEllipsoid(kUnequalAxes), air());
    int calls = 0;
    const OtherAction kick(
        scene,
        [&] {
          if (calls++ == 0) body.setLinearVelocity(body.getLinearVelocity() + btVector3(0, 0, 1));
        },
        !after);
    scene.step(1.0 / 60, 2);
    EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().z()), 1, 1e-6);
  }
}

TEST(Features, BulletsGyroscopicFlagsChangeNothing) {
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

TEST(Features, ASolverOfAnotherWorldsFluidIsReportedOnce) {
  FluidWorld scene, other;
  const auto solver = makeSolver<btSequentialImpulseConstraintSolver>(scene.fluid);
  other.world.setConstraintSolver(solver.get());
  scene.fluid.add(other.add(spinning(3)),
                  {std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1)), air()});
  other.step(1.0 / 60, 5);
  ASSERT_EQ(scene.said.size(), 1u);
  EXPECT_NE(scene.said[0].find("in another world"), std::string::npos);
}

TEST(Features, AMissingSolverIsReportedOnce) {
  FluidWorld scene;
  btSequentialImpulseConstraintSolver stock;
  scene.world.setConstraintSolver(&stock);
  scene.add(spinning(3), meshedEllipsoid(kUnequalAxes, 1), air());
  scene.step(1.0 / 60, 5);
  ASSERT_EQ(scene.said.size(), 1u);
  EXPECT_NE(scene.said[0].find("setConstraintSolver"), std::string::npos);
}

TEST(Features, AUsersForceActsOnceAndOnBodyAndAddedMass) {
  for (const int substeps : {1, 2, 4}) {
    FluidWorld scene;
    const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.12));
    btRigidBody& body = scene.add({}, shape, water());
    const int calls = 240 / substeps;
    const auto dt = static_cast<btScalar>(1.0 / 240);
    for (int i = 0; i < calls; ++i) {
      body.applyCentralForce({1, 0, 0});
      scene.world.stepSimulation(dt * static_cast<btScalar>(substeps), substeps + 1, dt);
    }
    const double inertia = 1 + water().density * shape.volume / 2;
    EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()) * inertia, 1,
                byPrecision(1e-12, 1e-4))
        << substeps << " substeps per call";
  }
}

}  // namespace
}  // namespace ambient::test
