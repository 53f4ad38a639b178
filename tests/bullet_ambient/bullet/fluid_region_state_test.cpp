#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "bullet_ambient/bullet/world_state.h"
#include "bullet_ambient/tasks/thread_pool.h"
#include "tests/bullet_ambient/bullet/region_world.h"

// Worlds with many regions: threads and saved states.
namespace ambient::test {
namespace {

// Bodies that cross from layer to layer; some of them collide.
struct Layers {
  explicit Layers(TaskRunner* runner = nullptr) {
    fluid.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    fluid.world.setGravity({0, 0, bt(-9.81)});
    fluid.registry.setTaskRunner(runner);
    for (int i = 0; i < 8; ++i) {
      FluidRegion layer = halfSpace(2, -1.0 * i, idealFluid(i % 3 ? 1 + i : 0));
      layer.bounds->highest.z() = 1 - 1.0 * i;
      layer.below.viscosity = 1e-5;
      if (i == 3) {
        layer.flow = [](const Vector3& x, double time) {
          return FlowSample{{std::sin(time + x.z()), 0, 0}, {std::cos(time), 0, 0}};
        };
      }
      fluid.registry.addRegion(layer);
    }
    shape->name = "ellipsoid";
    for (int i = 0; i < 24; ++i) {
      BodyDef def = tumblingBody({0.45 * (i % 6), 0.5 * std::floor(i / 6.0), 0.1 * i});
      def.mass = 1 + i;
      def.shape = &ball;
      btRigidBody& body = fluid.add(def);
      AttachDef attach;
      attach.fluid_body = shape;
      attach.medium = air();
      fluid.registry.attach(body, attach);
    }
  }
  std::string bits() const {
    WorldState state = saveState(fluid.world, fluid.registry);
    state.pairs.clear();
    state.contacts.clear();
    return encodeState(state);
  }

  btSphereShape ball{bt(0.2)};
  std::shared_ptr<FluidBody> shape = std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1));
  FluidWorld fluid;
};

TEST(FluidRegions, EndWithTheSameBitsOnAnyNumberOfThreads) {
  Layers alone;
  alone.fluid.step(kWorldStep, 150);
  EXPECT_GT(alone.fluid.registry.counters().medium_changes, 60);
  EXPECT_GT(alone.fluid.registry.counters().rows, 0);
  for (const int threads : {2, 3}) {
    ThreadPool pool(threads);
    Layers other(&pool);
    other.fluid.step(kWorldStep, 150);
    EXPECT_TRUE(alone.bits() == other.bits()) << threads;
  }
}

TEST(FluidRegions, GoOnBitForBitFromASavedState) {
  for (const int before : {20, 61, 90}) {
    Layers run, other;
    run.fluid.step(kWorldStep, before);
    const std::string bytes = encodeState(saveState(run.fluid.world, run.fluid.registry));
    const WorldState state =
        decodeState(bytes, "bytes", [&](const std::string&) { return other.shape; });
    restoreState(state, other.fluid.world, other.fluid.registry);
    EXPECT_EQ(other.fluid.registry.time(), run.fluid.registry.time());
    EXPECT_TRUE(run.bits() == other.bits());
    for (int i = 0; i < 60; ++i) {
      run.fluid.step(kWorldStep);
      other.fluid.step(kWorldStep);
      ASSERT_TRUE(run.bits() == other.bits()) << before << " and " << i;
    }
  }
}

// A state from a world of other regions: the next step finds what is there.
TEST(FluidRegions, AStateWhoseRegionsAreGoneIsTakenOver) {
  Layers run;
  run.fluid.step(kWorldStep, 60);
  const WorldState state = saveState(run.fluid.world, run.fluid.registry);
  for (int i = 0; i < 8; ++i) run.fluid.registry.removeRegion(static_cast<RegionId>(i));
  restoreState(state, run.fluid.world, run.fluid.registry);
  run.fluid.step(kWorldStep);
  const btCollisionObjectArray& objects = run.fluid.world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    EXPECT_EQ(run.fluid.registry.medium(*btRigidBody::upcast(objects[i])).density, air().density);
}

}  // namespace
}  // namespace ambient::test
