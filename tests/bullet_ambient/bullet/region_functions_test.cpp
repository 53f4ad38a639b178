#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/world_state.h"
#include "bullet_ambient/force/water_surface.h"
#include "tests/bullet_ambient/bullet/region_world.h"
#include "tests/support/part_bodies.h"

// Calls of a registry from functions of its regions, and the time that they are given.
namespace ambient::test {
namespace {

struct AskedWorld : FluidWorld {
  AskedWorld() {
    registry.setReport([this](const std::string& sentence) { said.push_back(sentence); });
    FluidRegion region = filledWith(idealFluid(900));
    region.flow = [this](const Vector3&, double time) {
      times.push_back(time);
      if (meddle) meddle();
      return FlowSample{};
    };
    asked = registry.addRegion(region);
    def.fluid_body = std::make_shared<FluidBody>(floatingEllipsoid(kUnequalAxes, 1));
    registry.attach(body, def);
    step(kWorldStep);
    times.clear();
    said.clear();  // that it is light
  }

  AttachDef def;
  btRigidBody& body = FluidWorld::add(tumblingBody(Vector3::Zero()));
  btRigidBody& other = FluidWorld::add(tumblingBody({3, 0, 0}));
  RegionId asked;
  std::function<void()> meddle;
  std::vector<double> times;
  std::vector<std::string> said;
};

const std::pair<const char*, void (*)(AskedWorld&)> kMeddling[] = {
    {"attach", [](AskedWorld& w) { w.registry.attach(w.other, w.def); }},
    {"detach", [](AskedWorld& w) { w.registry.detach(w.body); }},
    {"clear", [](AskedWorld& w) { w.registry.clear(); }},
    {"addRegion", [](AskedWorld& w) { w.registry.addRegion(filledWith(air())); }},
    {"setRegion", [](AskedWorld& w) { w.registry.setRegion(w.asked, filledWith(air())); }},
    {"removeRegion", [](AskedWorld& w) { w.registry.removeRegion(w.asked); }},
    {"setMedium", [](AskedWorld& w) { w.registry.setMedium(w.body, idealFluid(1)); }},
    {"setFluidBody", [](AskedWorld& w) { w.registry.setFluidBody(w.body, w.def.fluid_body); }},
    {"restoreState",
     [](AskedWorld& w) { restoreState(saveState(w.world, w.registry), w.world, w.registry); }},
};

TEST(RegionFunctions, CannotChangeTheirRegistry) {
  for (const auto& [name, change] : kMeddling) {
    AskedWorld world;
    world.meddle = [&world, change = change] { change(world); };
    world.step(kWorldStep, 3);
    ASSERT_EQ(world.said.size(), 1u) << name;
    EXPECT_EQ(
        world.said[0],
        std::string("bullet_ambient: the flow or the surface of a region of fluid has called ") +
            name +
            ", which changes what is asked for its fluid; nothing has changed: call it "
            "between steps");
    EXPECT_TRUE(world.registry.isAttached(world.body)) << name;
    EXPECT_EQ(world.registry.size(), 1u) << name;
    EXPECT_EQ(world.registry.medium(world.body).density, 900) << name;
    EXPECT_EQ(world.registry.counters().rejected, 3) << name;
    world.meddle = nullptr;
    change(world);
  }
}

TEST(RegionFunctions, ThatCatchTheRefusalGoOn) {
  AskedWorld world;
  int refused = 0;
  world.meddle = [&] {
    try {
      world.registry.detach(world.body);
    } catch (const std::logic_error&) {
      ++refused;
    }
  };
  world.step(kWorldStep, 3);
  EXPECT_EQ(refused, 3);
  EXPECT_EQ(world.registry.counters().rejected, 0);
}

TEST(RegionFunctions, CannotChangeItWhileABodyIsAttached) {
  AskedWorld world;
  world.meddle = [&world] { world.registry.detach(world.body); };
  world.registry.attach(world.other, world.def);
  EXPECT_TRUE(world.registry.isAttached(world.body));
  EXPECT_TRUE(world.registry.isAttached(world.other));
}

TEST(RegionFunctions, OfASurfaceCannotEither) {
  AskedWorld world;
  FluidRegion sea = filledWith(water());
  sea.above = air();
  sea.surface = std::make_shared<WaterSurfaceFunction>([&world](const Vector3& point, double) {
    world.registry.clear();
    return WaterSample{-point.z(), {0, 0, 0}, {0, 0, 0}};
  });
  world.registry.setRegion(world.asked, sea);
  world.step(kWorldStep, 2);
  EXPECT_EQ(world.said.size(), 1u);
  EXPECT_EQ(world.registry.size(), 1u);
}

TEST(RegionFunctions, MayChangeAnotherRegistry) {
  AskedWorld world, far_away;
  world.meddle = [&far_away] { far_away.registry.detach(far_away.body); };
  world.step(kWorldStep);
  EXPECT_FALSE(far_away.registry.isAttached(far_away.body));
  EXPECT_TRUE(world.said.empty());
}

// Infinite steps Bullet keeps from its bodies, and disables them.
TEST(StepsOfNoDuration, LeaveBodiesAndTimeAsTheyWere) {
  btBoxShape floor_shape(btVector3(9, 9, 1)), box(btVector3(1, 1, 1));
  for (const double duration : {kNotANumber, kFar}) {
    AskedWorld world;
    world.world.setGravity({0, 0, bt(-9.81)});
    BodyDef floor{0, Vector3::Zero(), {}, &floor_shape};
    floor.start.position = {50, 0, -1};
    world.FluidWorld::add(floor);
    BodyDef resting{900 * 9, Vector3::Constant(5000), {}, &box};
    resting.start.position = {50, 0, 1};
    const btRigidBody& stone = world.FluidWorld::add(resting, *world.def.fluid_body, Medium{});
    world.step(kWorldStep, 60);
    const btRigidBody before(world.body), stone_before(stone);
    const long long rejected = world.registry.counters().rejected;
    const double time = world.registry.time();
    world.world.stepSimulation(static_cast<btScalar>(duration), 0);
    for (const auto& [now, then] :
         {std::pair<const btRigidBody*, const btRigidBody*>{&world.body, &before},
          std::pair<const btRigidBody*, const btRigidBody*>{&stone, &stone_before}}) {
      EXPECT_TRUE(now->getWorldTransform() == then->getWorldTransform()) << duration;
      EXPECT_TRUE(now->getLinearVelocity() == then->getLinearVelocity()) << duration;
      EXPECT_TRUE(now->getAngularVelocity() == then->getAngularVelocity()) << duration;
    }
    EXPECT_EQ(world.registry.time(), time);
    EXPECT_EQ(world.registry.counters().rejected, rejected);
    ASSERT_EQ(world.said.size(), 1u);
    EXPECT_NE(world.said[0].find("stepped by a time that is not finite"), std::string::npos);
    world.times.clear();
    world.step(kWorldStep, 60);
    if (duration == kFar) continue;
    EXPECT_EQ(world.times.at(0), time);
    EXPECT_NE(world.body.getWorldTransform().getOrigin(), before.getWorldTransform().getOrigin());
    EXPECT_NEAR(stone.getWorldTransform().getOrigin().z(), 1, 0.05);
    EXPECT_EQ(world.registry.counters().rejected, rejected);
    EXPECT_EQ(world.said.size(), 1u);
  }
}

}  // namespace
}  // namespace ambient::test
