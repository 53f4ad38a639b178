#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "bullet_ambient/force/medium/waves.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/support/bodies/part_bodies.h"

// Solvers of one fluid on several threads, as btConstraintSolverPoolMt calls them for islands of
// a btDiscreteDynamicsWorldMt. Threads of the test in place of Bullet's: a Bullet that was built
// without BT_THREADSAFE, as Debian's is, has none.
namespace ambient::test {
namespace {

constexpr int kThreads = 4, kRounds = 25;

// Bodies without contacts to other islands, and one thread's solver.
struct Island {
  explicit Island(Fluid& fluid) : solver(makeSolver<btSequentialImpulseConstraintSolver>(fluid)) {}

  void add(Fluid& fluid, const BodyDef& def, const AttachDef& attach) {
    bodies.push_back(std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
        static_cast<btScalar>(def.mass), nullptr, &shape, toBullet(def.moments))));
    btRigidBody& body = *bodies.back();
    body.setWorldTransform(
        btTransform(toBullet(def.start.orientation), toBullet(def.start.position)));
    body.setLinearVelocity(toBullet(def.start.twist.linear));
    body.setAngularVelocity(toBullet(def.start.twist.angular));
    body.setGravity({0, 0, bt(-9.81)});
    fluid.add(body, attach);
    objects.push_back(&body);
  }

  void solve() {
    btContactSolverInfo info;
    info.m_timeStep = bt(1.0 / 30);
    solver->solveGroup(objects.data(), static_cast<int>(objects.size()), nullptr, 0, nullptr, 0,
                       info, nullptr, nullptr);
  }

  btEmptyShape shape;
  std::unique_ptr<FluidSolver<>> solver;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::vector<btCollisionObject*> objects;
};

AttachDef feather() {
  AttachDef def{std::make_shared<FluidBody>(floatingEllipsoid(Vector3(0.05, 0.05, 0.01), 1)),
                air()};
  return def;
}

// In each island: steps that are too long, a velocity that is not finite, masses that are not
// physical, a flow that fails, a sea, and, as no action runs, flights that nobody ends.
void fill(Island& island, Fluid& fluid, const AttachDef& attach, int number) {
  BodyDef def{2e-4, ellipsoidMoments(Vector3(0.05, 0.05, 0.01), 2e-4),
              startWith({Vector3(100, 50, 20), Vector3(300, 0, 200)})};
  for (int i = 0; i < 6; ++i) {
    def.start.position = {10.0 * i, 10.0 * number, i == 3 ? -500.0 : (i == 4 ? -1000.0 : 0.0)};
    island.add(fluid, def, attach);
  }
  const auto kNan = static_cast<btScalar>(kNotANumber);
  island.bodies[1]->setLinearVelocity({kNan, 0, 0});
  island.bodies[2]->setMassProps(bt(1e-4), {0, 0, 0});
}

FluidRegion failingFlow() {
  FluidRegion region = filledWith(air());
  region.bounds = RegionBounds{{-kFar, -kFar, -600}, {kFar, kFar, -400}};
  region.flow = [](const Vector3&, double) -> FlowSample { throw 1; };
  return region;
}

FluidRegion deepSea() {
  FluidRegion region = filledWith(water());
  region.bounds = RegionBounds{{-kFar, -kFar, -kFar}, {kFar, kFar, -900}};
  region.above = air();
  region.surface = std::make_shared<StillWater>(-1000, Vector3::UnitZ());
  return region;
}

// Starts all threads at once.
template <class Work>
void runTogether(int count, const Work& work) {
  std::atomic<int> waiting{count};
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i)
    threads.emplace_back([&, i] {
      for (--waiting; waiting > 0;) std::this_thread::yield();
      work(i);
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(ThreadRace, SolversOfOneFluidReportOneAfterTheOther) {
  for (int round = 0; round < kRounds; ++round) {
    FluidWorld scene;
    Fluid& fluid = scene.fluid;
    std::vector<std::string> said;  // by whichever thread: nothing but the fluid guards it
    std::atomic<int> inside{0};
    int most_inside = 0;
    fluid.setReport([&](const std::string& sentence) {
      most_inside = std::max(most_inside, ++inside);
      said.push_back(sentence);
      std::this_thread::yield();
      --inside;
    });
    fluid.addRegion(failingFlow());
    fluid.addRegion(deepSea());
    const AttachDef attach = feather();
    std::vector<std::unique_ptr<Island>> islands;
    for (int i = 0; i < kThreads; ++i) {
      islands.push_back(std::make_unique<Island>(fluid));
      fill(*islands.back(), fluid, attach, i);
    }
    said.clear();  // drops the reports of attaching
    runTogether(kThreads, [&](int i) {
      for (int step = 0; step < 3; ++step) islands[static_cast<std::size_t>(i)]->solve();
    });
    EXPECT_EQ(most_inside, 1);
    EXPECT_GE(said.size(), 4u);  // not finite, not physical, too long, no action
    EXPECT_EQ(std::set<std::string>(said.begin(), said.end()).size(), said.size());
    EXPECT_GE(fluid.counters().too_long, kThreads);
  }
}

}  // namespace
}  // namespace ambient::test
