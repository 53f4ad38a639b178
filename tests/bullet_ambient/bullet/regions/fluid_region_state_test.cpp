#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/state/saved_run.h"
#include "tests/support/thread_pool.h"

// Worlds with many regions: threads and saved states.
namespace ambient::test {
namespace {

// Bodies that cross layers; some collide.
struct Layers {
  explicit Layers(TaskRunner* runner = nullptr) {
    scene.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    scene.world.setGravity({0, 0, bt(-9.81)});
    scene.fluid.setTaskRunner(runner);
    for (int i = 0; i < 8; ++i) {
      FluidRegion layer = halfSpace(2, -1.0 * i, idealFluid(i % 3 ? 1 + i : 0));
      layer.bounds->highest.z() = 1 - 1.0 * i;
      layer.below.viscosity = 1e-5;
      if (i == 3) {
        layer.flow = [](const Vector3& x, double time) {
          return FlowSample{{std::sin(time + x.z()), 0, 0}, {std::cos(time), 0, 0}};
        };
      }
      scene.fluid.addRegion(layer);
    }
    shape->name = "ellipsoid";
    for (int i = 0; i < 24; ++i) {
      BodyDef def = tumblingBody({0.45 * (i % 6), 0.5 * std::floor(i / 6.0), 0.1 * i});
      def.mass = 1 + i;
      def.shape = &ball;
      btRigidBody& body = scene.add(def);
      AttachDef attach;
      attach.fluid_body = shape;
      attach.medium = air();
      scene.fluid.add(body, attach);
    }
  }
  std::string bits() const { return motionBytes(scene.fluid); }
  SavedRun saved() {
    return {scene.fluid, [this] { scene.step(kWorldStep); }};
  }

  btSphereShape ball{bt(0.2)};
  std::shared_ptr<FluidBody> shape = std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1));
  FluidWorld scene;
};

TEST(FluidRegions, EndWithTheSameBitsOnAnyNumberOfThreads) {
  Layers alone;
  alone.scene.step(kWorldStep, 150);
  EXPECT_GT(alone.scene.fluid.counters().medium_changes, 60);
  EXPECT_GT(alone.scene.fluid.counters().rows, 0);
  for (const int threads : {2, 3}) {
    ThreadPool pool(threads);
    Layers other(&pool);
    other.scene.step(kWorldStep, 150);
    EXPECT_TRUE(alone.bits() == other.bits()) << threads;
  }
}

TEST(FluidRegions, GoOnBitForBitFromASavedState) {
  for (const int before : {20, 61, 90}) {
    Layers run, other;
    run.scene.step(kWorldStep, before);
    expectGoesOn(run.saved(), other.saved(), lookupOf(other.shape), 60);
  }
}

// Restores a state of a world with other regions: the next step finds the present ones.
TEST(FluidRegions, AStateWhoseRegionsAreGoneIsTakenOver) {
  Layers run;
  run.scene.step(kWorldStep, 60);
  const WorldState state = run.scene.fluid.save();
  for (int i = 0; i < 8; ++i) run.scene.fluid.removeRegion(static_cast<RegionId>(i));
  run.scene.fluid.restore(state);
  run.scene.step(kWorldStep);
  const btCollisionObjectArray& objects = run.scene.world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    EXPECT_EQ(run.scene.of(*btRigidBody::upcast(objects[i])).medium().density, air().density);
}

}  // namespace
}  // namespace ambient::test
