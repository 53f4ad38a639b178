#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "bullet_ambient/reading.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

// Factors on the added mass and on the loads of a body.
namespace ambient::test {
namespace {

const Vector3 kMoments(0.02, 0.03, 0.04);

btRigidBody& addEllipsoid(FluidWorld& world, double density) {
  BodyDef def;
  def.mass = 2;
  def.moments = kMoments;
  return world.add(def, facelessEllipsoid(kUnequalAxes), idealFluid(density));
}

TEST(Factors, ScaleTheAddedMassAtRest) {
  for (const double factor : {0.3, 1.0, 1.7}) {
    FluidWorld world;
    btRigidBody& body = addEllipsoid(world, 40);
    const Matrix6 dry = rigidBodyInertia(2, kMoments.asDiagonal());
    const Matrix6 added = world.of(body).inertia() - dry;
    world.of(body).setFactors(factor, 1);
    EXPECT_LT((world.of(body).inertia() - dry - factor * added).norm(),
              byPrecision(1e-13, 1e-6) * added.norm());
    body.applyCentralForce({0, 0, bt(3)});
    world.step(kWorldStep);
    const double expected = 3 * kWorldStep / (2 + factor * added(5, 5));
    EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().z()), expected,
                byPrecision(1e-12, 1e-6) * expected);
  }
}

double terminalSpeed(double factor) {
  FluidWorld world;
  world.world.setGravity({0, 0, bt(-kGravity)});
  BodyDef def;
  def.mass = 300;
  def.moments = Vector3::Constant(120);
  btRigidBody& body = world.add(def, meshedEllipsoid(Vector3::Ones(), 2), idealFluid(40));
  world.of(body).setFactors(1, factor);
  world.step(kWorldStep, 4000);
  return std::abs(static_cast<double>(body.getLinearVelocity().z()));
}

// Without viscosity drag goes with the square of the speed. A step, of 0.005 times in which the
// ball slows down, is wrong by less than the square of that.
TEST(Factors, ScaleTheLoads) {
  const double speed = terminalSpeed(1);
  for (const double factor : {0.5, 2.0})
    EXPECT_NEAR(terminalSpeed(factor) * std::sqrt(factor), speed, byPrecision(1e-5, 1e-4) * speed);
}

/// A box half in water.
btRigidBody& addFloat(FluidWorld& world) {
  world.world.setGravity({0, 0, bt(-kGravity)});
  world.fluid.addRegion(seaUnderAir());
  FluidBody box = boxBody(kBoxSize);
  box.added_mass.diagonal() << 0.004, 0.006, 0.003, 0.05, 0.07, 0.15;
  BodyDef def;
  def.mass = 500 * kBoxSize.prod();
  def.moments = Vector3(4.2, 6.4, 8);
  return world.add(def, box, air());
}

TEST(Factors, ScaleTheAddedMassAtTheSurface) {
  FluidWorld world;
  btRigidBody& body = addFloat(world);
  world.step(kWorldStep);
  const RigidState pose = readState(body);
  const auto at = [&](double factor) {
    world.of(body).setFactors(factor, 1);
    return Matrix6(world.of(body).inertia());
  };
  const Matrix6 once = at(1), half = at(0.5), twice = at(2);
  EXPECT_GT(twice(5, 5), 1.2 * once(5, 5));
  EXPECT_LT((twice - once - 2 * (once - half)).norm(), 1e-9 * once.norm());
  EXPECT_EQ(readState(body).position, pose.position);
}

TEST(Factors, AreInSavedStates) {
  FluidWorld one, other;
  btRigidBody& here = addFloat(one);
  btRigidBody& there = addFloat(other);
  one.of(here).setFactors(1.3, 0.6);
  one.step(kWorldStep, 20);
  other.fluid.restore(one.fluid.save());
  one.step(kWorldStep, 50);
  other.step(kWorldStep, 50);
  EXPECT_TRUE(moveAlike(here, there));
  other.of(there).setFactors(1, 0.6);
  one.step(kWorldStep, 5);
  other.step(kWorldStep, 5);
  EXPECT_FALSE(moveAlike(here, there));
}

TEST(Factors, MustBePositiveAndFinite) {
  FluidWorld world;
  btRigidBody& body = addEllipsoid(world, 40);
  const Matrix6 inertia = world.of(body).inertia();
  for (const double factor : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(world.of(body).setFactors(factor, 1), std::invalid_argument);
    EXPECT_THROW(world.of(body).setFactors(1, factor), std::invalid_argument);
  }
  EXPECT_EQ(Matrix6(world.of(body).inertia()), inertia);
}

}  // namespace
}  // namespace ambient::test
