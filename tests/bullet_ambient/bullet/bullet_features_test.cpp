#include <gtest/gtest.h>

#include <cmath>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/free_body.h"

// Features of Bullet that a program may use on ambient bodies as on any other.
namespace ambient::test {
namespace {

double speedAlongX(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().x());
}
double placeAlongX(const btRigidBody& body) {
  return static_cast<double>(body.getWorldTransform().getOrigin().x());
}

TEST(Features, DampingIsWhatTheUserHasSet) {
  // Bullet: v (1 - d)^t.
  FluidWorld fluid;
  BodyDef def;
  def.start.twist = {Vector3(0, 0, 2), Vector3(3, 0, 0)};
  btRigidBody& body = fluid.add(def, shapeWithoutFaces(Matrix6::Identity(), 0), idealFluid(1));
  body.setDamping(bt(0.3), bt(0.6));
  fluid.step(1.0 / 64, 64);
  EXPECT_NEAR(speedAlongX(body), 3 * 0.7, byPrecision(1e-12, 1e-5));
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().z()), 2 * 0.4,
              byPrecision(1e-12, 1e-5));
}

TEST(Features, GravityOfASingleBodyMakesItsWeightAndBuoyancy) {
  const FluidBody shape = facelessEllipsoid(kUnequalAxes);
  const double mass = 2 * shape.volume * 1000;
  const Vector3 down(1, -2, -5);
  FluidWorld fluid;
  BodyDef def;
  def.mass = mass;
  btRigidBody& own = fluid.add(def, shape, idealFluid(1000));
  def.start.position = {10, 0, 0};
  const btRigidBody& other = fluid.add(def, shape, idealFluid(1000));
  own.setGravity(toBullet(down));
  fluid.step(1.0 / 64);
  // Half of the weight is buoyancy; every axis has its own total inertia.
  const Vector3 inertia = fluid.registry.inertia(own).diagonal().tail<3>();
  const Vector3 expected = (mass / 2 * down / 64).cwiseQuotient(inertia);
  EXPECT_LT((toVector3(own.getLinearVelocity()) - expected).norm(), byPrecision(1e-4, 1e-4));
  EXPECT_TRUE(other.getLinearVelocity() == btVector3(0, 0, 0));
}

TEST(Features, ABodyThatIgnoresTheWorldsGravityIsNotLifted) {
  FluidWorld fluid;
  btRigidBody& body = fluid.add({}, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  fluid.world.removeRigidBody(&body);
  body.setFlags(body.getFlags() | BT_DISABLE_WORLD_GRAVITY);
  fluid.world.setGravity({0, 0, bt(-9.81)});
  fluid.world.addRigidBody(&body);
  fluid.step(1.0 / 64, 10);
  EXPECT_TRUE(body.getLinearVelocity() == btVector3(0, 0, 0));
}

// Flies towards a thin wall, 2 m per step.
struct Shot {
  FluidWorld fluid;
  btBoxShape wall{btVector3(bt(0.01), 5, 5)};
  btSphereShape ball{bt(0.1)};
  btRigidBody* body = nullptr;

  explicit Shot(double spin) {
    BodyDef def;
    def.mass = 0;
    def.moments.setZero();
    def.start.position = {5, 0, 0};
    def.shape = &wall;
    fluid.add(def);
    def = {};
    def.start.twist = {Vector3(spin, 0, 0), Vector3(120, 0, 0)};
    def.shape = &ball;
    body = &fluid.add(def, shapeWithoutFaces(Matrix6::Identity(), 0), idealFluid(1));
  }
};

TEST(Features, ContinuousCollisionStopsABodyAtAWall) {
  for (const double spin : {1.0, 200.0}) {
    Shot with(spin), without(spin);
    with.body->setCcdMotionThreshold(bt(0.05));
    with.body->setCcdSweptSphereRadius(bt(0.09));
    with.fluid.step(1.0 / 60, 30);
    without.fluid.step(1.0 / 60, 30);
    EXPECT_LT(placeAlongX(*with.body), 5);
    EXPECT_GT(placeAlongX(*without.body), 6);  // it tunnels
    EXPECT_TRUE(readState(*with.body).isFinite());
  }
}

struct Place : btMotionState {
  btTransform now = btTransform::getIdentity();
  void getWorldTransform(btTransform& transform) const override { transform = now; }
  void setWorldTransform(const btTransform& transform) override { now = transform; }
};

// Pose by motion state after calls of `call_step`, with fixed substeps of 1/64 s.
btTransform motionStateAfter(double call_step, int calls) {
  FluidWorld fluid;
  Place place;
  BodyDef def;
  def.start.twist = {Vector3(0, 0, 3), Vector3(1, 0, 0)};
  // Curved: the added mass across is twice that along.
  Matrix6 added = Matrix6::Identity();
  added(4, 4) = 3;
  btRigidBody& body = fluid.add(def, shapeWithoutFaces(added, 0), idealFluid(1));
  body.setMotionState(&place);
  for (int i = 0; i < calls; ++i) fluid.world.stepSimulation(bt(call_step), 10, bt(1.0 / 64));
  body.setMotionState(nullptr);
  return place.now;
}

TEST(Features, MotionStatesAreInterpolatedBetweenSubsteps) {
  // Bullet shows the world one substep late: after the time t + 1/64 s, where t is half way between
  // two substeps, the pose must lie half way between theirs.
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

TEST(Features, APushGivesItsImpulseAtOnce) {
  // applyImpulse divides by the dry mass, as documented.
  FluidWorld fluid;
  btRigidBody& body = fluid.add({}, shapeWithoutFaces(Matrix6::Identity(), 0), idealFluid(1));
  body.applyCentralImpulse({3, 0, 0});
  EXPECT_NEAR(speedAlongX(body), 3, 1e-6);
  fluid.step(1.0 / 60, 10);
  EXPECT_NEAR(speedAlongX(body), 3, 1e-5);
}

TEST(Features, AForceAtAPointTurnsTheBody) {
  FluidWorld fluid;
  Matrix6 added = Matrix6::Identity();
  btRigidBody& body = fluid.add({}, shapeWithoutFaces(added, 0), idealFluid(1));
  body.applyForce({0, 1, 0}, {bt(0.5), 0, 0});
  fluid.step(1.0 / 64);
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().z()) * 64 * 2, 0.5,
              byPrecision(1e-6, 1e-5));
}

TEST(Features, ADetachedBodyFliesOnAsInAVacuum) {
  FluidWorld fluid;
  fluid.world.setGravity({0, 0, bt(-10)});
  btRigidBody& body = fluid.add({}, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  fluid.step(1.0 / 64, 5);
  const double before = static_cast<double>(body.getLinearVelocity().z());
  EXPECT_GT(before, 0);  // it rises
  EXPECT_TRUE(fluid.registry.detach(body));
  fluid.step(1.0 / 64);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().z()) - before, -10.0 / 64, 1e-6);
}

// The solver has already given it the mean velocity of its flight, with which Bullet has moved it.
TEST(Features, ABodyDetachedBetweenSolverAndActionKeepsTheMeanVelocityOfItsFlight) {
  struct Detach : btActionInterface {
    AmbientRegistry* registry = nullptr;
    btRigidBody* body = nullptr;
    void updateAction(btCollisionWorld*, btScalar) override { registry->detach(*body); }
    void debugDraw(btIDebugDraw*) override {}
  };
  const double dt = 1.0 / 64;
  FluidWorld fluid, attached;
  BodyDef def;
  def.start.twist.linear = {1, 2, 3};
  btRigidBody& body = fluid.add(def, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  const btRigidBody& twin = attached.add(def, facelessEllipsoid(kUnequalAxes), idealFluid(1000));
  fluid.world.removeAction(&fluid.action);
  Detach detach;
  detach.registry = &fluid.registry;
  detach.body = &body;
  fluid.world.addAction(&detach);
  fluid.world.addAction(&fluid.action);

  fluid.step(dt);
  attached.step(dt);
  EXPECT_EQ(fluid.registry.size(), 0u);
  const Vector3 way = toVector3(body.getWorldTransform().getOrigin());
  EXPECT_EQ(way, toVector3(twin.getWorldTransform().getOrigin()));
  const Vector3 velocity = toVector3(body.getLinearVelocity());
  EXPECT_LT((velocity - way / dt).norm(), byPrecision(1e-12, 1e-5));
  EXPECT_GT((velocity - toVector3(twin.getLinearVelocity())).norm(), 0.01) << "of the flight's end";
  fluid.step(dt, 2);
  EXPECT_EQ(toVector3(body.getLinearVelocity()), velocity);
  fluid.world.removeAction(&detach);
}

TEST(Features, ABodyMadeKinematicIsLeftToBullet) {
  FluidWorld fluid;
  BodyDef def;
  def.start.twist.linear = {1, 0, 0};
  btRigidBody& body = fluid.add(def, meshedEllipsoid(kUnequalAxes, 1), water());
  fluid.step(1.0 / 64);
  fluid.world.removeRigidBody(&body);
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  fluid.world.addRigidBody(&body);
  const long long evaluations = fluid.registry.counters(body).load_evaluations;
  const btVector3 place = body.getWorldTransform().getOrigin();
  fluid.step(1.0 / 64, 5);
  EXPECT_EQ(fluid.registry.counters(body).load_evaluations, evaluations);
  EXPECT_TRUE(body.getWorldTransform().getOrigin() == place);
}

TEST(Features, AMassOfZeroIsLeftToBulletUntilItIsPositiveAgain) {
  FluidWorld fluid;
  fluid.world.setGravity({0, 0, bt(-10)});
  btRigidBody& body = fluid.add({}, facelessEllipsoid(kUnequalAxes), idealFluid(1));
  fluid.step(1.0 / 64);
  body.setMassProps(0, {0, 0, 0});
  fluid.step(1.0 / 64, 3);
  body.setMassProps(2, {1, 1, 1});
  body.updateInertiaTensor();
  fluid.step(1.0 / 64);
  EXPECT_NEAR(fluid.registry.inertia(body)(0, 0), 1, 0.1);
  EXPECT_NEAR(fluid.registry.inertia(body)(5, 5),
              2 + facelessEllipsoid(kUnequalAxes).added_mass(5, 5), 1e-6);
}

TEST(Features, TheMediumMayChangeInEveryStep) {
  // A gust, given anew in each step: same motion as one that is given once.
  Medium wind = air();
  wind.velocity = {5, 0, 0};
  FluidWorld once, anew;
  const btRigidBody& a = once.add({}, meshedEllipsoid(kUnequalAxes, 1), wind);
  const btRigidBody& b = anew.add({}, meshedEllipsoid(kUnequalAxes, 1), wind);
  for (int i = 0; i < 60; ++i) {
    anew.registry.setMedium(b, wind);
    once.step(1.0 / 60);
    anew.step(1.0 / 60);
  }
  EXPECT_GT(speedAlongX(a), 0);
  EXPECT_TRUE(a.getWorldTransform() == b.getWorldTransform());
  EXPECT_TRUE(a.getLinearVelocity() == b.getLinearVelocity());
  // The history of the loads is kept: no extra evaluation in each step.
  EXPECT_EQ(anew.registry.counters(b).load_evaluations, once.registry.counters(a).load_evaluations);
}

TEST(Features, TwoRunsGiveTheSameBits) {
  btTransform end[2];
  for (btTransform& pose : end) {
    FluidWorld fluid;
    fluid.world.setGravity({0, 0, bt(-9.81)});
    BodyDef def;
    def.start.twist = {Vector3(1, 2, 3), Vector3(3, 2, 1)};
    const btRigidBody& body = fluid.add(def, meshedEllipsoid(kUnequalAxes, 2), water());
    fluid.step(1.0 / 60, 120);
    pose = body.getWorldTransform();
  }
  EXPECT_TRUE(end[0] == end[1]);
}

}  // namespace
}  // namespace ambient::test
