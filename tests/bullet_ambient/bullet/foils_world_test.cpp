#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/foil.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

// Foils of bodies in a world, docs/theory.md section 22.
namespace ambient::test {
namespace {

/// A wing, a fin that stands on it, and a cambered tail, around an ellipsoid.
std::vector<Foil> gliderFoils() {
  Foil wing, fin, tail;
  wing.position = {0.05, 0, 0};
  wing.span = 0.8;
  wing.chord = 0.15;
  fin.position = {-0.3, 0, 0.1};
  fin.span_axis = {0, 0, 1};
  fin.span = 0.2;
  fin.chord = 0.1;
  fin.aspect = 4;
  tail = fin;
  tail.span_axis = {0, 1, 0};
  tail.camber = 0.03;
  return {wing, fin, tail};
}

btRigidBody& addGlider(FluidWorld& world, const std::shared_ptr<const Foils>& foils,
                       double mass = 4, const Twist& start = {}) {
  btRigidBody& body = world.add({mass, ellipsoidMoments(kUnequalAxes, mass), startWith(start)});
  static const auto shape = std::make_shared<const FluidBody>(facelessEllipsoid(kUnequalAxes));
  AttachDef attach{shape, idealFluid(100)};
  attach.flow.foils = foils;
  world.fluid.add(body, attach);
  return body;
}

// No body gains energy from its foils in still fluid, however light it is and long the step;
// without other loads they alone slow it down.
TEST(FoilsInAWorld, NeverFeedEnergy) {
  const auto foils = std::make_shared<Foils>(gliderFoils());
  for (const double mass : {0.01, 4.0})
    for (const int rate : {30, 60, 240})
      for (const double angle : {0.0, 0.6}) {
        foils->turn(1, angle);
        FluidWorld world;
        btRigidBody& body = addGlider(world, foils, mass, {{4, -3, 6}, {5, 1, -2}});
        const double first = world.of(body).kineticEnergy();
        double energy = first;
        for (int n = 0; n < 4 * rate; ++n) {
          world.step(1.0 / rate);
          const double now = world.of(body).kineticEnergy();
          ASSERT_LE(now, energy * (1 + byPrecision(1e-12, 1e-5))) << mass << " " << rate;
          energy = now;
        }
        EXPECT_LT(energy, 0.1 * first) << mass << " " << rate;
      }
}

// Bodies of one shape with foils of their own: what one of them turns, the other does not feel.
TEST(FoilsInAWorld, TurnForOneBodyAlone) {
  FluidWorld world;
  const auto left = std::make_shared<Foils>(gliderFoils());
  const auto right = std::make_shared<Foils>(gliderFoils());
  left->turn(1, -0.2);
  right->turn(1, 0.2);
  const Twist ahead{Vector3::Zero(), {3, 0, 0}};
  btRigidBody& one = addGlider(world, left, 4, ahead);
  btRigidBody& other = addGlider(world, right, 4, ahead);
  world.step(kWorldStep, 20);
  const double turned = static_cast<double>(one.getAngularVelocity().z());
  EXPECT_GT(std::abs(turned), 0.05);
  EXPECT_NEAR(static_cast<double>(other.getAngularVelocity().z()), -turned,
              byPrecision(1e-6, 1e-4) * std::abs(turned));
  // At once, without a new attachment.
  left->turn(1, 0.2);
  world.step(kWorldStep, 60);
  EXPECT_LT(static_cast<double>(one.getAngularVelocity().z()) * turned, 0);
}

TEST(FoilsInAWorld, StayWithABodyThatGetsASavedState) {
  std::vector<std::shared_ptr<Foils>> foils;
  for (int i = 0; i < 3; ++i) foils.push_back(std::make_shared<Foils>(gliderFoils()));
  FluidWorld one, other, third;
  btRigidBody& here = addGlider(one, foils[0], 4, {{1, 2, 3}, {3, 0.2, 0}});
  btRigidBody& there = addGlider(other, foils[1]);
  btRigidBody& last = addGlider(third, foils[2]);
  one.step(kWorldStep, 10);
  const WorldState state = one.fluid.save();
  other.fluid.restore(state);
  const auto lookup = [&](const std::string&) { return one.of(here).fluidBody(); };
  third.fluid.restore(decodeState(encodeState(state), "state", lookup));
  for (FluidWorld* world : {&one, &other, &third}) world->step(kWorldStep, 20);
  EXPECT_TRUE(moveAlike(here, there));
  EXPECT_TRUE(moveAlike(here, last));
  // Each world turns foils of its own.
  foils[0]->turn(1, 0.3);
  for (FluidWorld* world : {&one, &other, &third}) world->step(kWorldStep, 5);
  EXPECT_FALSE(moveAlike(here, there));
  EXPECT_TRUE(moveAlike(there, last));
}

}  // namespace
}  // namespace ambient::test
