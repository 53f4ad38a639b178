#include <gtest/gtest.h>

#include <memory>

#include "bullet_ambient/force/medium/water_surface.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {
namespace {

constexpr double kDepth = 1.5;  // of the centre at the start [m]

/// Returns the height to which a body of 0.115 times the density of water leaps [m].
double leapOf(const FluidBody& shape, double hertz) {
  FluidWorld world;
  world.world.setGravity({0, 0, bt(-9.81)});
  FluidRegion sea;
  sea.below = water();
  sea.above = air();
  sea.surface = std::make_shared<StillWater>(0.0, Vector3(0, 0, 1));
  world.fluid.addRegion(sea);
  BodyDef def;
  def.mass = 0.1146 * water().density * shape.volume;
  def.moments.setConstant(0.1 * def.mass);
  def.start.position.z() = -kDepth;
  btRigidBody& body = world.add(def);
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(shape);
  world.fluid.add(body, attach);
  double before = -kDepth, now = -kDepth;
  for (double time = 0; time < 3; time += 1 / hertz) {
    world.step(1 / hertz);
    const double next = readState(body).position.z();
    // The apex of the parabola through three heights.
    if (next < now && now > 0)
      return now - (next - before) * (next - before) / (8 * (before - 2 * now + next));
    before = now;
    now = next;
  }
  return 0;
}

TEST(Leap, IsAsHighAtStepsOfGamesAsAtShortOnes) {
  const FluidBody shapes[] = {floatingBall(0.5), floatingBox({0.8, 0.8, 0.8})};
  for (const FluidBody& shape : shapes) {
    const double limit = leapOf(shape, 2000);
    EXPECT_GT(limit, 0.5);
    for (const double hertz : {60, 144, 240})
      EXPECT_NEAR(leapOf(shape, hertz), limit, 0.03 * limit) << shape.volume << ", " << hertz;
  }
}

}  // namespace
}  // namespace ambient::test
