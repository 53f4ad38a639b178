#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bullet_ambient/threads.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/thread_pool.h"

namespace ambient::test {
namespace {

struct Poses {
  std::vector<btTransform> poses;
  AmbientCounters counters;
};

// Poses after steps with flying, colliding and hinged bodies.
Poses flyBodies(TaskRunner* runner) {
  constexpr int kBodies = 40;
  btBoxShape box(btVector3(btScalar(0.3), btScalar(0.25), btScalar(0.1)));
  FluidWorld scene;
  scene.fluid.setTaskRunner(runner);
  scene.world.setGravity({0, 0, btScalar(-9.81)});
  const FluidBody shape = meshedEllipsoid(Vector3(0.3, 0.25, 0.1), 1);
  BodyDef def{1, Vector3(0.02, 0.03, 0.04), {}, &box};
  std::vector<btRigidBody*> bodies;
  for (int i = 0; i < kBodies; ++i) {
    def.start.position = {0.7 * (i % 8), 0.6 * std::floor(i / 8.0), 0.02 * i};
    def.start.twist = {Vector3(0.1 * i, 2, 1), Vector3(1, 0.2 * i, 0)};
    bodies.push_back(&scene.add(def, shape, i % 2 ? air() : water()));
  }
  btPoint2PointConstraint joint(*bodies[3], btVector3(0, 0, btScalar(0.5)));
  scene.world.addConstraint(&joint);
  scene.step(1.0 / 60, 90);
  Poses end;
  for (const btRigidBody* body : bodies) end.poses.push_back(body->getWorldTransform());
  end.counters = scene.fluid.counters();
  scene.world.removeConstraint(&joint);
  return end;
}

void expectSame(const Poses& a, const Poses& b) {
  for (std::size_t i = 0; i < a.poses.size(); ++i) EXPECT_TRUE(a.poses[i] == b.poses[i]) << i;
  EXPECT_EQ(a.counters.load_evaluations, b.counters.load_evaluations);
  EXPECT_EQ(a.counters.rows, b.counters.rows);
}

TEST(ParallelFlight, EndsWithTheSameBitsOnAnyNumberOfThreads) {
  const Poses alone = flyBodies(nullptr);
  EXPECT_GT(alone.counters.rows, 0);
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    expectSame(alone, flyBodies(&pool));
  }
}

TEST(ParallelFlight, RunsByBulletsSchedulerOrWithout) {
  BulletTaskRunner runner;
  expectSame(flyBodies(nullptr), flyBodies(&runner));
}

TEST(ParallelFlight, IsHandedAllFreeBodiesAtOnce) {
  class Recorder final : public TaskRunner {
   public:
    void runAll(const Task& task, int count) noexcept override {
      counts.push_back(count);
      for (int i = count; i-- > 0;) task.run(i);  // reversed order
    }
    std::vector<int> counts;
  } recorder;
  FluidWorld scene;
  scene.fluid.setTaskRunner(&recorder);
  const FluidBody shape = meshedEllipsoid(Vector3(0.3, 0.25, 0.1), 0);
  for (int i = 0; i < 10; ++i) scene.add({}, shape, air());
  scene.step(1.0 / 60);
  EXPECT_EQ(recorder.counts, std::vector<int>{10});
}

}  // namespace
}  // namespace ambient::test
