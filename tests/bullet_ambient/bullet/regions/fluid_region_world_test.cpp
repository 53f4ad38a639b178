#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/refusal_of.h"
#include "tests/support/threads.h"

namespace ambient::test {
namespace {

// Regions of fluid, and the search for a body's region.

TEST(FluidRegions, ABodyInOneMovesAsIfTheFluidWereItsOwn) {
  const Medium medium{300, 1e-3, {0.3, 0, 0.1}, {0, 0.2, 0}};
  btSphereShape ball(bt(0.2));
  btBoxShape floor_shape(btVector3(9, 9, 1));
  const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  FluidWorld own, regions;
  regions.fluid.addRegion(filledWith(medium));
  for (FluidWorld* scene : {&own, &regions}) {
    scene->world.setGravity({0, 0, bt(-9.81)});
    scene->add({0, Vector3::Zero(), startAt({0, 0, -1}), &floor_shape});
    for (const double height : {0.25, 40.0}) {
      BodyDef def = tumblingBody({0, 0, height});
      def.mass = 20;
      def.shape = &ball;
      scene->add(def, shape, scene == &own ? medium : Medium{});
    }
  }
  own.step(kWorldStep, 200);
  regions.step(kWorldStep, 200);
  for (int i = 1; i < 3; ++i) {
    const auto* a = btRigidBody::upcast(own.world.getCollisionObjectArray()[i]);
    const auto* b = btRigidBody::upcast(regions.world.getCollisionObjectArray()[i]);
    EXPECT_TRUE(moveAlike(*a, *b)) << i;
    EXPECT_EQ(regions.of(*b).medium().density, medium.density);
    EXPECT_EQ(regions.of(*b).inertia(), own.of(*a).inertia());
  }
  EXPECT_GT(own.fluid.counters().rows, 0);
  EXPECT_EQ(regions.fluid.counters().rows, own.fluid.counters().rows);
}

TEST(FluidRegions, TheHighestPriorityCountsAndThenTheLastAdded) {
  FluidWorld scene;
  const btRigidBody& body =
      scene.add(tumblingBody(Vector3::Zero()), facelessEllipsoid(kUnequalAxes), idealFluid(7));
  const auto density = [&] {
    scene.step(kWorldStep);
    return scene.of(body).medium().density;
  };
  EXPECT_EQ(density(), 7);
  const RegionId sea = scene.fluid.addRegion(filledWith(idealFluid(1)));
  EXPECT_EQ(density(), 1);
  const RegionId pool = scene.fluid.addRegion(filledWith(idealFluid(2)));
  EXPECT_EQ(density(), 2);
  FluidRegion first = filledWith(idealFluid(3));
  first.priority = 1;
  scene.fluid.setRegion(sea, first);
  EXPECT_EQ(density(), 3);
  EXPECT_EQ(scene.of(body).region(), sea);
  first.priority = 0;
  scene.fluid.setRegion(sea, first);
  EXPECT_EQ(density(), 2) << "setRegion keeps its turn";
  FluidRegion elsewhere = halfSpace(2, 100, idealFluid(4));
  elsewhere.priority = 5;
  scene.fluid.addRegion(elsewhere);
  EXPECT_EQ(density(), 2);
  EXPECT_TRUE(scene.fluid.removeRegion(pool));
  EXPECT_FALSE(scene.fluid.removeRegion(pool));
  EXPECT_EQ(density(), 3);
  scene.fluid.removeRegion(sea);
  EXPECT_EQ(density(), 7);
  EXPECT_EQ(scene.of(body).region(), RegionId::kNone);
}

TEST(FluidRegions, ABodyThatDoesNotFollowKeepsItsOwn) {
  FluidWorld scene;
  AttachDef def{std::make_shared<FluidBody>(facelessEllipsoid(kUnequalAxes)), idealFluid(7)};
  def.follow_regions = false;
  btRigidBody& body = scene.add(tumblingBody(Vector3::Zero()));
  scene.fluid.add(body, def);
  scene.fluid.addRegion(filledWith(idealFluid(1)));
  scene.step(kWorldStep);
  EXPECT_EQ(scene.of(body).medium().density, 7);
  EXPECT_EQ(scene.of(body).counters().regions_asked, 0);
}

// A body falls from a vacuum into an ideal fluid. Entry changes neither pose nor velocity; later
// motion equals that of a body started there.
TEST(FluidRegions, ABodyThatCrossesKeepsItsVelocity) {
  const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  FluidWorld crossing, stock, inside;
  crossing.fluid.addRegion(halfSpace(0, 1, water()));
  const BodyDef def = tumblingBody(Vector3::Zero());
  btRigidBody& body = crossing.add(def, shape, Medium{});
  btRigidBody& dry = stock.add(def);
  int steps = 0;
  while (!(dry.getWorldTransform().getOrigin().x() >= 1)) {
    crossing.step(kWorldStep);
    stock.step(kWorldStep);
    ++steps;
    ASSERT_TRUE(moveAlike(body, dry)) << steps;
  }
  EXPECT_GT(steps, 50);
  EXPECT_EQ(crossing.fluid.counters().medium_changes, 0);
  btRigidBody& put = inside.add(def, shape, water());
  put.setWorldTransform(dry.getWorldTransform());
  put.setLinearVelocity(dry.getLinearVelocity());
  put.setAngularVelocity(dry.getAngularVelocity());
  for (int i = 0; i < 20; ++i) {
    crossing.step(kWorldStep);
    inside.step(kWorldStep);
    ASSERT_TRUE(moveAlike(body, put)) << i;
  }
  EXPECT_EQ(crossing.fluid.counters().medium_changes, 1);
  EXPECT_EQ(crossing.of(body).inertia(), inside.of(put).inertia());
}

// Drift from the circle in a rigidly rotating fluid, for a body of equal density without faces.
// Exact: no drift, since the fluid's acceleration acts on displaced and added mass.
double driftOnCircle(double step) {
  const double kRate = 1.2;
  FluidWorld scene;
  FluidRegion whirl = filledWith(idealFluid(1000));
  whirl.flow = [=](const Vector3& x, double) {
    return FlowSample{kRate * Vector3(-x.y(), x.x(), 0), -kRate * kRate * Vector3(x.x(), x.y(), 0)};
  };
  scene.fluid.addRegion(whirl);
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.1));
  const btRigidBody& body = scene.add({1000 * shape.volume, Vector3::Constant(0.02),
                                       startAt({2, 0, 0}, {Vector3::Zero(), {0, 2 * kRate, 0}})},
                                      shape, Medium{});
  const int steps = static_cast<int>(std::lround(4 / step));
  scene.step(step, steps);
  const Vector3 exact(2 * std::cos(4 * kRate), 2 * std::sin(4 * kRate), 0);
  return (toVector3(body.getWorldTransform().getOrigin()) - exact).norm();
}

TEST(FluidRegions, ABodyOfTheFluidsDensityGoesWithAWhirl) {
  const double coarse = driftOnCircle(1.0 / 60), fine = driftOnCircle(1.0 / 120);
  EXPECT_LT(fine, 0.1);
  EXPECT_NEAR(coarse / fine, 2, 0.1);  // first order: flow sampled at the start of a step
}

TEST(FluidRegions, FlowsSeeTheTimeOfTheWorldAtTheStartOfTheStep) {
  FluidWorld scene;
  std::vector<double> times;
  FluidRegion region = filledWith(idealFluid(1));
  region.flow = [&](const Vector3&, double time) {
    times.push_back(time);
    return FlowSample{};
  };
  scene.add(tumblingBody(Vector3::Zero()), facelessEllipsoid(kUnequalAxes), Medium{});
  scene.step(0.25, 2);
  scene.fluid.addRegion(region);
  scene.step(0.25, 2);
  EXPECT_EQ(times, (std::vector<double>{0.5, 0.75}));
  EXPECT_EQ(scene.fluid.time(), 1);
}

TEST(FluidRegions, AFlowThatIsNotFiniteIsDroppedAndCounted) {
  FluidWorld scene;
  std::string said;
  scene.fluid.setReport([&](const std::string& sentence) { said += sentence; });
  FluidRegion region = filledWith(water());
  region.flow = [](const Vector3&, double) { return FlowSample{{std::nan(""), 0, 0}, {0, 0, 0}}; };
  scene.fluid.addRegion(region);
  const btRigidBody& body =
      scene.add(tumblingBody(Vector3::Zero()), meshedEllipsoid(kUnequalAxes, 1), Medium{});
  scene.step(kWorldStep, 5);
  EXPECT_EQ(scene.fluid.counters().rejected, 6);  // once when it was attached
  EXPECT_EQ(scene.of(body).medium().density, water().density);
  EXPECT_TRUE(toVector3(body.getWorldTransform().getOrigin()).allFinite());
  EXPECT_NE(said.find("flow or the surface of the region of fluid 0 is not finite"),
            std::string::npos);
}

TEST(FluidRegions, ARegionThatABodyCannotMeetChangesNothing) {
  FluidWorld scene;
  AttachDef def{std::make_shared<FluidBody>(facelessEllipsoid(kUnequalAxes)), idealFluid(7)};
  def.flow.own_law = [](const std::shared_ptr<const FluidBody>&,
                        const LoadSettings& settings) -> std::shared_ptr<const SurfaceLoads> {
    if (settings.density > 100) throw std::invalid_argument("too dense");
    return nullptr;
  };
  btRigidBody& body = scene.add(tumblingBody(Vector3::Zero()));
  scene.fluid.add(body, def);
  const RegionId id = scene.fluid.addRegion(filledWith(idealFluid(8)));
  EXPECT_THROW(scene.fluid.addRegion(filledWith(water())), std::invalid_argument);
  EXPECT_THROW(scene.fluid.setRegion(id, filledWith(water())), std::invalid_argument);
  EXPECT_THROW(scene.fluid.setRegion(static_cast<RegionId>(7), filledWith(air())),
               std::invalid_argument);
  FluidRegion wrong = filledWith(air());
  wrong.below.density = -1;
  const std::string sentence =
      ": density of the medium [kg/m^3] is -1; must be zero or positive and finite";
  EXPECT_EQ(refusalOf<std::invalid_argument>([&] { scene.fluid.addRegion(wrong); }),
            "region of fluid 1" + sentence);
  EXPECT_EQ(refusalOf<std::invalid_argument>([&] { scene.fluid.setRegion(id, wrong); }),
            "region of fluid 0" + sentence);
  scene.step(kWorldStep);
  EXPECT_EQ(scene.of(body).medium().density, 8);
}

TEST(FluidRegions, OfTheirOwnMediumAndShapeBodiesInThemCanChange) {
  FluidWorld scene;
  scene.fluid.addRegion(halfSpace(0, 0, idealFluid(8)));
  btRigidBody& body =
      scene.add(tumblingBody({1, 0, 0}), facelessEllipsoid(kUnequalAxes), idealFluid(1));
  EXPECT_EQ(scene.of(body).medium().density, 8);  // since it was attached
  scene.of(body).setMedium(idealFluid(3));
  EXPECT_EQ(scene.of(body).medium().density, 8);
  const Matrix6 before = scene.of(body).inertia();
  scene.of(body).setFluidBody(std::make_shared<FluidBody>(facelessEllipsoid(2 * kUnequalAxes)));
  EXPECT_GT(scene.of(body).inertia()(5, 5), before(5, 5) + 1);
  EXPECT_EQ(scene.of(body).medium().density, 8);
  body.setWorldTransform(btTransform(btQuaternion(0, 0, 0, 1), {-1, 0, 0}));
  scene.step(kWorldStep);
  EXPECT_EQ(scene.of(body).medium().density, 3);
  Medium current = idealFluid(3);
  current.velocity = {0, 0, 1};
  scene.of(body).setMedium(current);
  EXPECT_EQ(scene.of(body).medium().velocity.z(), 1);
}

btRigidBody& addRestingBall(FluidWorld& scene, const Medium& medium) {
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.2));
  const double mass = 998 * shape.volume;
  btRigidBody& body =
      scene.add({mass, ellipsoidMoments(Vector3::Constant(0.2), mass)}, shape, medium);
  body.forceActivationState(ACTIVE_TAG);
  return body;
}

TEST(FluidRegions, NobodySleepsInAFlowThatMayChange) {
  FluidWorld scene;
  FluidRegion region = filledWith(idealFluid(998));
  region.flow = [](const Vector3&, double time) {
    return FlowSample{{0, 0, 0}, {time > 4 ? 1.0 : 0.0, 0, 0}};
  };
  scene.fluid.addRegion(region);
  const btRigidBody& body = addRestingBall(scene, Medium{});
  scene.step(1.0 / 60, 300);
  EXPECT_TRUE(body.isActive());
  EXPECT_GT(body.getLinearVelocity().x(), bt(0.9));
}

TEST(FluidRegions, NeverLookAtABodyThatIsGone) {
  FluidWorld scene;
  auto body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(1, nullptr, nullptr, btVector3(1, 1, 1)));
  scene.fluid.add(*body, {std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1))});
  body.reset();
  const RegionId id = scene.fluid.addRegion(filledWith(air()));
  scene.step(kWorldStep);
  scene.fluid.setRegion(id, filledWith(water()));
  scene.step(kWorldStep);
  EXPECT_TRUE(scene.fluid.removeRegion(id));
  scene.step(kWorldStep);
}

TEST(FluidRegions, AWorldWithoutAnyAsksNothing) {
  FluidWorld scene;
  scene.add(tumblingBody(Vector3::Zero()), meshedEllipsoid(kUnequalAxes, 1), air());
  scene.step(kWorldStep, 10);
  EXPECT_EQ(scene.fluid.counters().regions_asked, 0);
  EXPECT_EQ(scene.fluid.counters().medium_changes, 0);
  FluidRegion far_away = halfSpace(0, 1e6, water());
  scene.fluid.addRegion(far_away);
  scene.fluid.addRegion(far_away);
  scene.step(kWorldStep, 10);
  EXPECT_EQ(scene.fluid.counters().regions_asked, 10);  // both are in one box
  EXPECT_EQ(scene.fluid.counters().medium_changes, 0);
}

// Worlds with many regions: threads and saved states.

// Bodies that cross layers; some collide.
struct Layers {
  explicit Layers(const TaskRunner& runner = nullptr) {
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
      scene.fluid.add(body, {shape, air()});
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
    Layers other(onThreads(threads));
    other.scene.step(kWorldStep, 150);
    EXPECT_TRUE(alone.bits() == other.bits()) << threads;
  }
}

TEST(FluidRegions, GoOnBitForBitFromASavedState) {
  for (const int before : {20, 61, 90}) {
    Layers run, other;
    run.scene.step(kWorldStep, before);
    expectGoesOn(run.saved(), other.saved(), 60);
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
