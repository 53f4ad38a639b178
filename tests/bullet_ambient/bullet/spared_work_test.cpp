#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/threads.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/threads.h"

namespace ambient::test {
namespace {

// What a scene does not need is not computed, by the counters of the fluid.

constexpr double kStep = 1.0 / 60;

BodyDef bodyAt(double height) {
  return {1, ellipsoidMoments(kUnequalAxes, 1),
          startAt({0, 0, height}, {Vector3(1, 2, 3), Vector3(4, 0, 1)})};
}

// The counts of the next step alone.
AmbientCounters countStep(FluidWorld& scene) {
  const AmbientCounters before = scene.fluid.counters();
  scene.step(kStep);
  const AmbientCounters after = scene.fluid.counters();
  AmbientCounters step;
  step.substeps = after.substeps - before.substeps;
  step.load_evaluations = after.load_evaluations - before.load_evaluations;
  step.faces = after.faces - before.faces;
  step.rows = after.rows - before.rows;
  return step;
}

void expectNothing(const AmbientCounters& step) {
  EXPECT_EQ(step.substeps, 0);
  EXPECT_EQ(step.load_evaluations, 0);
  EXPECT_EQ(step.faces, 0);
  EXPECT_EQ(step.rows, 0);
}

TEST(SparedWork, ADensityOfZeroCostsNothing) {
  FluidWorld scene;
  scene.add(bodyAt(0), meshedEllipsoid(kUnequalAxes, 1), Medium{});
  expectNothing(countStep(scene));
}

TEST(SparedWork, ASleepingBodyCostsNothing) {
  FluidWorld scene;
  btRigidBody& body = scene.add(bodyAt(0), meshedEllipsoid(kUnequalAxes, 1), air());
  EXPECT_GT(countStep(scene).load_evaluations, 0);
  body.forceActivationState(ISLAND_SLEEPING);
  expectNothing(countStep(scene));
}

TEST(SparedWork, ABodyWithoutFacesHasNoLoadsToEvaluate) {
  FluidWorld scene;
  scene.add(bodyAt(0), facelessEllipsoid(kUnequalAxes), water());
  const AmbientCounters step = countStep(scene);
  EXPECT_GT(step.substeps, 0);
  EXPECT_EQ(step.load_evaluations, 0);
}

TEST(SparedWork, EveryEvaluationSumsEveryFaceButOfASphereNone) {
  FluidWorld scene;
  FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  scene.add(bodyAt(0), shape, air());
  const AmbientCounters by_faces = countStep(scene);
  EXPECT_GT(by_faces.load_evaluations, 0);
  EXPECT_EQ(by_faces.faces, by_faces.load_evaluations * static_cast<long long>(shape.faces.size()));
  FluidWorld other;
  shape.sphere_radius = 0.2;
  other.add(bodyAt(0), shape, air());
  const AmbientCounters by_radius = countStep(other);
  EXPECT_GT(by_radius.load_evaluations, 0);
  EXPECT_EQ(by_radius.faces, 0);
}

TEST(SparedWork, AFreeBodyHasNoRowsToRewrite) {
  FluidWorld scene;
  scene.add(bodyAt(0), meshedEllipsoid(kUnequalAxes, 1), air());
  for (int i = 0; i < 10; ++i) EXPECT_EQ(countStep(scene).rows, 0);
}

TEST(SparedWork, ABodyThatIsOnlyNearAnotherIsNotRewritten) {
  // Boxes overlap in the broadphase; spheres do not touch.
  btSphereShape ball(btScalar(0.1));
  FluidWorld scene;
  BodyDef def = bodyAt(0);
  def.shape = &ball;
  def.start.twist = {};
  scene.add(def, meshedEllipsoid(kUnequalAxes, 1), water());
  def.start.position = {0.15, 0.15, 0};
  scene.add(def, meshedEllipsoid(kUnequalAxes, 1), water());
  scene.step(kStep);
  ASSERT_EQ(scene.dispatcher.getNumManifolds(), 1);
  EXPECT_EQ(countStep(scene).rows, 0);
}

// Tells how many bodies the last group of Bullet's solver had, and of how many groups it made rows.
class WatchedSolver : public FluidSolver<> {
 public:
  using FluidSolver<>::FluidSolver;
  int bodies = -1, groups = 0;

 protected:
  void convertContacts(btPersistentManifold** manifolds, int manifold_count,
                       const btContactSolverInfo& info) override {
    ++groups;
    FluidSolver<>::convertContacts(manifolds, manifold_count, info);
  }
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** objects, int object_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* drawer) override {
    bodies = m_tmpSolverBodyPool.size();
    return FluidSolver<>::solveGroupCacheFriendlyIterations(objects, object_count, manifolds,
                                                            manifold_count, constraints,
                                                            constraint_count, info, drawer);
  }
};

TEST(SparedWork, TheSolverDoesNotKnowABodyThatFloatsAlone) {
  btSphereShape ball(btScalar(0.1));
  FluidWorld scene;
  WatchedSolver solver(ambientBodiesOf(scene.fluid).shared_from_this());
  scene.world.setConstraintSolver(&solver);
  BodyDef def = bodyAt(0);
  def.shape = &ball;
  def.start.twist = {};
  btRigidBody& in_fluid = scene.add(def, meshedEllipsoid(kUnequalAxes, 1), water());
  scene.step(kStep);
  EXPECT_EQ(solver.bodies, 0);
  EXPECT_EQ(solver.groups, 0);
  EXPECT_EQ(scene.of(in_fluid).counters().substeps, 1);
  def.start.position = {10, 0, 0};
  scene.add(def);
  scene.step(kStep);
  EXPECT_EQ(solver.bodies, 1) << "of a body without a fluid";
  def.start.position = {0.15, 0.15, 0};
  scene.add(def, meshedEllipsoid(kUnequalAxes, 1), water());
  scene.step(kStep);
  EXPECT_EQ(solver.bodies, 3) << "of two whose bounds overlap";
}

TEST(SparedWork, ALargeSlowBodyNeedsOneEvaluationPerStep) {
  const Vector3 semi_axes(5, 3, 2);
  FluidWorld scene;
  scene.add({1e5, ellipsoidMoments(semi_axes, 1e5),
             startWith({Vector3(0, 0.01, 0), Vector3(0.3, 0, 0.1)})},
            meshedEllipsoid(semi_axes, 1), water());
  scene.step(kStep, 2);
  for (int i = 0; i < 20; ++i) {
    const AmbientCounters step = countStep(scene);
    EXPECT_EQ(step.substeps, 1);
    EXPECT_EQ(step.load_evaluations, 1);
  }
}

TEST(SparedWork, ADetachedBodyCostsNothing) {
  FluidWorld scene;
  btRigidBody& body = scene.add(bodyAt(0), meshedEllipsoid(kUnequalAxes, 1), air());
  scene.add(bodyAt(10), meshedEllipsoid(kUnequalAxes, 1), Medium{});
  scene.step(kStep);
  scene.of(body).remove();
  expectNothing(countStep(scene));
}

TEST(SparedWork, BodiesOfOneShapeShareItsData) {
  FluidWorld scene;
  scene.fluid.addRegion(seaUnderAir(-50));
  for (const PressureLaw law : {PressureLaw::kPublished, PressureLaw::kForm}) {
    AttachDef def{std::make_shared<const FluidBody>(floatingEllipsoid(kUnequalAxes, 2)), air()};
    def.flow.law = law;
    const AmbientBody* bodies[2] = {};
    for (const AmbientBody*& ambient : bodies) {
      btRigidBody& body = scene.add(bodyAt(2));
      scene.fluid.add(body, def);
      ambient = ambientBodiesOf(scene.fluid).find(&body);
    }
    EXPECT_EQ(bodies[0]->models, bodies[1]->models);
    EXPECT_EQ(bodies[0]->models->media.size(), 2U);
    EXPECT_EQ(bodies[0]->models->surfaces.size(), 1U);
    EXPECT_NE(bodies[0]->floating, bodies[1]->floating);
  }
}

struct Poses {
  std::vector<btTransform> poses;
  AmbientCounters counters;
};

// Poses after steps with flying, colliding and hinged bodies.
Poses flyBodies(const TaskRunner& runner) {
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
  scene.contents.take(
      std::make_unique<btPoint2PointConstraint>(*bodies[3], btVector3(0, 0, btScalar(0.5))));
  scene.step(1.0 / 60, 90);
  Poses end;
  for (const btRigidBody* body : bodies) end.poses.push_back(body->getWorldTransform());
  end.counters = scene.fluid.counters();
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
  for (const int threads : {1, 2, 4}) expectSame(alone, flyBodies(onThreads(threads)));
}

TEST(ParallelFlight, RunsByBulletsSchedulerOrWithout) {
  expectSame(flyBodies(nullptr), flyBodies(runByBullet));
}

TEST(ParallelFlight, IsHandedAllFreeBodiesAtOnce) {
  std::vector<int> counts;
  FluidWorld scene;
  scene.fluid.setTaskRunner([&](int count, const std::function<void(int)>& run) {
    counts.push_back(count);
    for (int i = count; i-- > 0;) run(i);  // reversed order
  });
  const FluidBody shape = meshedEllipsoid(Vector3(0.3, 0.25, 0.1), 0);
  for (int i = 0; i < 10; ++i) scene.add({}, shape, air());
  scene.step(1.0 / 60);
  EXPECT_EQ(counts, std::vector<int>{10});
}

// Bullet puts slow bodies to sleep after two seconds; sleeping bodies must wake up again.

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
  scene.fluid.add(body,
                  {std::make_shared<FluidBody>(facelessEllipsoid(kBallAxes)), idealFluid(1000)});
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
    BodyDef def{0, Vector3::Zero(), startAt({0, 0, -1}), &ground};
    scene.add(def);
    def = {400, Vector3::Constant(400 * 0.06), {}, &cube};
    def.start.position = {0, 0, 0.3};
    box = &scene.add(def);
    if (in_water) {
      AttachDef attach{std::make_shared<FluidBody>(meshedEllipsoid(Vector3::Constant(0.3), 1)),
                       idealFluid(1000)};
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
