#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/sphere_fall.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {
namespace {

constexpr double kRadius = 0.12;

BodyDef sphere(double mass) {
  return {mass, Vector3::Constant(0.4 * mass * kRadius * kRadius), {}, nullptr};
}

void setGravity(FluidWorld& scene) {
  scene.world.setGravity({0, 0, static_cast<btScalar>(-kGravity)});
}

double fallSpeed(const btRigidBody& body) {
  return -static_cast<double>(body.getLinearVelocity().z());
}
double fallDistance(const btRigidBody& body) {
  return -static_cast<double>(body.getWorldTransform().getOrigin().z());
}

class FallingSphere : public ::testing::TestWithParam<double> {};

// Spheres from a balloon in water to a basketball in air.
TEST_P(FallingSphere, FollowsItsClosedForm) {
  const double mass = GetParam();
  const Medium medium = mass < 0.1 ? water() : air();
  const reference::SphereFall exact{mass, kRadius, medium.density, kGravity};
  const double duration = 2 * exact.settlingTime();
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    FluidWorld scene;
    setGravity(scene);
    Medium inviscid = medium;
    inviscid.viscosity = 0;
    const btRigidBody& body =
        scene.add(sphere(mass), gaussSphere(kRadius), inviscid, PressureLaw::kPublished);
    const int steps = 100 << (2 * k);
    scene.step(duration / steps, steps);
    errors[k] = std::abs(fallDistance(body) / exact.distance(duration) - 1);
    EXPECT_NEAR(fallSpeed(body) / exact.velocity(duration), 1, byPrecision(1e-4, 1e-4));
  }
  // Order 2 in the step, down to the rounding of the position.
  EXPECT_LT(errors[0], 2e-4);
  EXPECT_LT(errors[1], errors[0] / 10 + byPrecision(1e-12, 2e-5));
}

INSTANTIATE_TEST_SUITE_P(Masses, FallingSphere, ::testing::Values(0.01, 0.62, 4.3));

FluidBody smoothBall() {
  FluidBody ball = floatingEllipsoid(Vector3::Constant(kRadius), 2);
  ball.sphere_radius = kRadius;
  return ball;
}

// By the form law the wake has to develop first, eq. (51b) to (51d).
TEST(SphereInWorld, FallsFasterUntilItsWakeHasDeveloped) {
  Medium inviscid = water();
  inviscid.viscosity = 0;
  const auto speedAfter = [&](double time, PressureLaw law) {
    FluidWorld scene;
    setGravity(scene);
    const btRigidBody& body = scene.add(sphere(12), smoothBall(), inviscid, law);
    scene.step(1.0 / 240, static_cast<int>(240 * time));
    return fallSpeed(body);
  };
  const double early = speedAfter(0.4, PressureLaw::kForm);
  EXPECT_GT(early, 1.02 * speedAfter(0.4, PressureLaw::kPublished));
  EXPECT_LT(early, 0.4 * kGravity);
  const double late = speedAfter(6, PressureLaw::kPublished);
  EXPECT_NEAR(speedAfter(6, PressureLaw::kForm), late, 1e-3 * late);
}

TEST(SphereInWorld, WakesAreSavedAndRestored) {
  FluidWorld scene;
  setGravity(scene);
  const btRigidBody& body = scene.add(sphere(2), smoothBall(), water());
  scene.step(1.0 / 120, 10);
  WorldState state = scene.fluid.save();
  const auto heightAfter = [&] {
    scene.step(1.0 / 120, 10);
    return body.getWorldTransform().getOrigin().z();
  };
  const btScalar first = heightAfter();
  scene.fluid.restore(state);
  EXPECT_EQ(heightAfter(), first);
  state.bodies[0].ambient->wake = {};
  scene.fluid.restore(state);
  EXPECT_NE(heightAfter(), first);
}

TEST(SphereInWorld, GravityDoesNotActOnTheAddedMass) {
  const double mass = 0.01;
  const reference::SphereFall exact{mass, kRadius, water().density, kGravity};
  FluidWorld scene;
  setGravity(scene);
  const btRigidBody& body =
      scene.add(sphere(mass), facelessEllipsoid(Vector3::Constant(kRadius)), water());
  scene.step(1.0 / 240);
  EXPECT_NEAR(fallSpeed(body) * 240, exact.firstAcceleration(),
              std::abs(exact.firstAcceleration()) * byPrecision(1e-12, 1e-5));
}

TEST(SphereInWorld, SubstepsPerCallDoNotChangeTheMotion) {
  const double dt = 1.0 / 240;
  btVector3 position[3], velocity[3];
  for (int k = 0; k < 3; ++k) {
    FluidWorld scene;
    setGravity(scene);
    const btRigidBody& body =
        scene.add(sphere(0.62), meshedEllipsoid(Vector3::Constant(kRadius), 2), air());
    const int substeps = 1 << k;
    const auto step = static_cast<btScalar>(dt);
    // Slightly more than whole substeps: the remainder stays in the world below a step.
    for (int i = 0; i < 240 / substeps; ++i) {
      scene.world.stepSimulation(step * static_cast<btScalar>(substeps), substeps + 1, step);
    }
    position[k] = body.getWorldTransform().getOrigin();
    velocity[k] = body.getLinearVelocity();
  }
  for (int k = 1; k < 3; ++k) {
    EXPECT_EQ(position[k].z(), position[0].z());
    EXPECT_EQ(velocity[k].z(), velocity[0].z());
  }
}

TEST(SphereInWorld, AUsersForceActsOnceAndOnBodyAndAddedMass) {
  for (const int substeps : {1, 2, 4}) {
    FluidWorld scene;
    const FluidBody shape = facelessEllipsoid(Vector3::Constant(kRadius));
    btRigidBody& body = scene.add(sphere(1), shape, water());
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

TEST(SphereInWorld, DriftsWithASteadyCurrent) {
  Medium stream = water();
  stream.velocity = Vector3(0.3, -0.2, 0.1);
  FluidWorld scene;
  const FluidBody shape = meshedEllipsoid(Vector3::Constant(kRadius), 2);
  BodyDef def = sphere(water().density * shape.volume);
  def.start.twist.linear = stream.velocity;
  const btRigidBody& body = scene.add(def, shape, stream);
  scene.step(1.0 / 60, 120);
  EXPECT_LT((toVector3(body.getLinearVelocity()) - stream.velocity).norm(),
            byPrecision(1e-14, 1e-6));
  EXPECT_LT((toVector3(body.getWorldTransform().getOrigin()) - 2 * stream.velocity).norm(),
            byPrecision(1e-13, 1e-5));
}

}  // namespace
}  // namespace ambient::test
