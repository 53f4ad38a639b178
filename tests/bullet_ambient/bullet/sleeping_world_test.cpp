#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"

// Bullet puts slow bodies to sleep after two seconds; sleeping bodies must wake up again.
namespace ambient::test {
namespace {

const Vector3 kBallAxes = Vector3::Constant(0.2);  // sphere: no unstable motion

btRigidBody& addSleepy(FluidWorld& scene, const Twist& twist, const Medium& medium,
                       const FluidBody& shape = facelessEllipsoid(kBallAxes)) {
  BodyDef def;
  def.mass = 1000 * shape.volume;
  def.moments = ellipsoidMoments(kBallAxes, def.mass);
  def.start.twist = twist;
  btRigidBody& body = scene.add(def, shape, medium);
  body.forceActivationState(ACTIVE_TAG);
  return body;
}

TEST(Sleeping, DoesNotFreezeABodyThatMoves) {
  const Vector3 none = Vector3::Zero();
  for (const Twist& twist : {Twist{none, Vector3(0.01, 0, 0)}, Twist{none, Vector3(0.5, 0, 0)},
                             Twist{Vector3(0, 0, 0.05), none}, Twist{none, none}}) {
    FluidWorld scene;
    scene.world.setGravity({0, 0, static_cast<btScalar>(-9.81)});
    const btRigidBody& body = addSleepy(scene, twist, idealFluid(1000));
    scene.step(1.0 / 60, 600);
    EXPECT_EQ(body.isActive(), twist.vector().norm() > 0) << twist.vector().transpose();
    const double speed = twist.linear.x(), rounding = byPrecision(1e-9, 1e-3);
    EXPECT_NEAR(readState(body).position.x(), 10 * speed, rounding * speed);
    EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().z()), twist.angular.z(), 1e-5);
  }
}

TEST(Sleeping, EndsWhereTheMediumChanges) {
  Medium same = idealFluid(1000), brine = idealFluid(1200), current = idealFluid(1000);
  current.velocity = {0.5, 0, 0};
  for (const Medium& medium : {same, brine, current}) {
    FluidWorld scene;
    scene.world.setGravity({0, 0, static_cast<btScalar>(-9.81)});
    const btRigidBody& body = addSleepy(scene, {}, same, meshedEllipsoid(kBallAxes, 2));
    scene.step(1.0 / 60, 300);
    ASSERT_FALSE(body.isActive());
    scene.of(body).setMedium(medium);
    scene.step(1.0 / 60, 300);
    const bool is_other = medium.density != same.density || medium.velocity != same.velocity;
    EXPECT_EQ(body.isActive(), is_other);
    EXPECT_EQ(body.getLinearVelocity().length() > bt(0.1), is_other);
  }
}

TEST(Sleeping, IsNotMistakenForAMissingSolver) {
  FluidWorld scene;
  btRigidBody& body = addSleepy(scene, {}, idealFluid(1000));
  scene.step(1.0 / 60, 300);
  ASSERT_FALSE(body.isActive());
  EXPECT_TRUE(scene.said.empty());
  // Another action wakes the body between solver and action: the solver has skipped it.
  const OtherAction wake(scene, [&body] { body.activate(); });
  scene.step(1.0 / 60, 3);
  EXPECT_TRUE(scene.said.empty()) << scene.said[0];
}

TEST(Sleeping, EndsWhenABodyIsAttached) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, 0});
  BodyDef def;
  btRigidBody& body = scene.add(def);
  body.forceActivationState(ISLAND_SLEEPING);
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid(kBallAxes));
  attach.medium = idealFluid(1000);
  scene.fluid.add(body, attach);
  EXPECT_TRUE(body.isActive());
}

// A box on the floor and a ball that will hit it.
struct Floor {
  FluidWorld scene;
  btBoxShape ground{btVector3(20, 20, 1)};
  btBoxShape cube{btVector3(static_cast<btScalar>(0.3), static_cast<btScalar>(0.3),
                            static_cast<btScalar>(0.3))};
  btSphereShape sphere{static_cast<btScalar>(0.2)};
  btRigidBody* box = nullptr;
  btRigidBody* ball = nullptr;

  explicit Floor(bool in_water) {
    scene.world.setGravity({0, 0, static_cast<btScalar>(-9.81)});
    BodyDef def{0, Vector3::Zero(), {}, &ground};
    def.start.position = {0, 0, -1};
    scene.add(def);
    def = {400, Vector3::Constant(400 * 0.06), {}, &cube};
    def.start.position = {0, 0, 0.3};
    box = &scene.add(def);
    if (in_water) {
      AttachDef attach;
      attach.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(Vector3::Constant(0.3), 1));
      attach.medium = idealFluid(1000);
      attach.fluid_frame.translation = Vector3(0.02, 0.01, 0);
      scene.fluid.add(*box, attach);
    }
    box->forceActivationState(ACTIVE_TAG);
    def = {5, Vector3::Constant(0.1), {}, &sphere};
    def.start.position = {-12, 0, 0.3};
    def.start.twist.linear = {3, 0, 0};
    ball = &scene.add(def);
    ball->setGravity({0, 0, 0});
  }
  // Steps until the box is awake or asleep, 1000 at most.
  int stepsUntil(bool is_awake) {
    for (int i = 0; i < 1000; ++i) {
      if (box->isActive() == is_awake) return i;
      scene.step(1.0 / 60);
    }
    return 1000;
  }
};

TEST(Sleeping, ComesAndGoesInStillWaterAsInStockBullet) {
  Floor dry(false), wet(true);
  const int slept = dry.stepsUntil(false);
  EXPECT_GT(slept, 100);
  EXPECT_EQ(wet.stepsUntil(false), slept);
  const int woken = dry.stepsUntil(true);
  EXPECT_GT(woken, 10);
  EXPECT_LT(woken, 1000);
  EXPECT_EQ(wet.stepsUntil(true), woken);
}

}  // namespace
}  // namespace ambient::test
