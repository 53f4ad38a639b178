#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/fluid.h"
#include "tests/bullet_ambient/bullet/region_world.h"

// Regions of fluid, and bodies that find theirs.
namespace ambient::test {
namespace {

Medium blowing(const Vector3& velocity) {
  Medium wind = air();
  wind.velocity = velocity;
  return wind;
}

bool isSame(const btRigidBody& a, const btRigidBody& b) {
  return a.getWorldTransform() == b.getWorldTransform() &&
         a.getLinearVelocity() == b.getLinearVelocity() &&
         a.getAngularVelocity() == b.getAngularVelocity();
}

TEST(FluidRegions, ABodyInOneMovesAsIfTheFluidWereItsOwn) {
  const Medium medium{300, 1e-3, {0.3, 0, 0.1}, {0, 0.2, 0}};
  btSphereShape ball(bt(0.2));
  btBoxShape floor_shape(btVector3(9, 9, 1));
  const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  FluidWorld own, regions;
  regions.registry.addRegion(filledWith(medium));
  for (FluidWorld* fluid : {&own, &regions}) {
    fluid->world.setGravity({0, 0, bt(-9.81)});
    BodyDef floor{0, Vector3::Zero(), {}, &floor_shape};
    floor.start.position = {0, 0, -1};
    fluid->add(floor);
    for (const double height : {0.25, 40.0}) {
      BodyDef def = tumblingBody({0, 0, height});
      def.mass = 20;
      def.shape = &ball;
      fluid->add(def, shape, fluid == &own ? medium : Medium{});
    }
  }
  own.step(kWorldStep, 200);
  regions.step(kWorldStep, 200);
  for (int i = 1; i < 3; ++i) {
    const auto* a = btRigidBody::upcast(own.world.getCollisionObjectArray()[i]);
    const auto* b = btRigidBody::upcast(regions.world.getCollisionObjectArray()[i]);
    EXPECT_TRUE(isSame(*a, *b)) << i;
    EXPECT_EQ(regions.registry.medium(*b).density, medium.density);
    EXPECT_EQ(regions.registry.inertia(*b), own.registry.inertia(*a));
  }
  EXPECT_GT(own.registry.counters().rows, 0);
  EXPECT_EQ(regions.registry.counters().rows, own.registry.counters().rows);
}

TEST(FluidRegions, TheHighestPriorityCountsAndThenTheLastAdded) {
  FluidWorld fluid;
  const btRigidBody& body =
      fluid.add(tumblingBody(Vector3::Zero()), facelessEllipsoid(kUnequalAxes), idealFluid(7));
  const auto density = [&] {
    fluid.step(kWorldStep);
    return fluid.registry.medium(body).density;
  };
  EXPECT_EQ(density(), 7);
  const RegionId sea = fluid.registry.addRegion(filledWith(idealFluid(1)));
  EXPECT_EQ(density(), 1);
  const RegionId pool = fluid.registry.addRegion(filledWith(idealFluid(2)));
  EXPECT_EQ(density(), 2);
  FluidRegion first = filledWith(idealFluid(3));
  first.priority = 1;
  fluid.registry.setRegion(sea, first);
  EXPECT_EQ(density(), 3);
  EXPECT_EQ(fluid.registry.region(body), sea);
  first.priority = 0;
  fluid.registry.setRegion(sea, first);
  EXPECT_EQ(density(), 2) << "setRegion keeps its turn";
  FluidRegion elsewhere = halfSpace(2, 100, idealFluid(4));
  elsewhere.priority = 5;
  fluid.registry.addRegion(elsewhere);
  EXPECT_EQ(density(), 2);
  EXPECT_TRUE(fluid.registry.removeRegion(pool));
  EXPECT_FALSE(fluid.registry.removeRegion(pool));
  EXPECT_EQ(density(), 3);
  fluid.registry.removeRegion(sea);
  EXPECT_EQ(density(), 7);
  EXPECT_EQ(fluid.registry.region(body), RegionId::kNone);
}

TEST(FluidRegions, ABodyThatDoesNotFollowKeepsItsOwn) {
  FluidWorld fluid;
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid(kUnequalAxes));
  def.medium = idealFluid(7);
  def.follow_regions = false;
  btRigidBody& body = fluid.add(tumblingBody(Vector3::Zero()));
  fluid.registry.attach(body, def);
  fluid.registry.addRegion(filledWith(idealFluid(1)));
  fluid.step(kWorldStep);
  EXPECT_EQ(fluid.registry.medium(body).density, 7);
  EXPECT_EQ(fluid.registry.counters(body).regions_asked, 0);
}

// Falls out of a vacuum into an ideal fluid: pose and velocity stay in the step where it enters,
// and then it moves as a body that was put there.
TEST(FluidRegions, ABodyThatCrossesKeepsItsVelocity) {
  const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  FluidWorld crossing, stock, inside;
  crossing.registry.addRegion(halfSpace(0, 1, water()));
  const BodyDef def = tumblingBody(Vector3::Zero());
  btRigidBody& body = crossing.add(def, shape, Medium{});
  btRigidBody& dry = stock.add(def);
  int steps = 0;
  while (!(dry.getWorldTransform().getOrigin().x() >= 1)) {
    crossing.step(kWorldStep);
    stock.step(kWorldStep);
    ++steps;
    ASSERT_TRUE(isSame(body, dry)) << steps;
  }
  EXPECT_GT(steps, 50);
  EXPECT_EQ(crossing.registry.counters().medium_changes, 0);
  btRigidBody& put = inside.add(def, shape, water());
  put.setWorldTransform(dry.getWorldTransform());
  put.setLinearVelocity(dry.getLinearVelocity());
  put.setAngularVelocity(dry.getAngularVelocity());
  for (int i = 0; i < 20; ++i) {
    crossing.step(kWorldStep);
    inside.step(kWorldStep);
    ASSERT_TRUE(isSame(body, put)) << i;
  }
  EXPECT_EQ(crossing.registry.counters().medium_changes, 1);
  EXPECT_EQ(crossing.registry.inertia(body), inside.registry.inertia(put));
}

TEST(FluidRegions, AVacuumLeavesABodyToStockBullet) {
  FluidWorld fluid, stock;
  fluid.registry.addRegion(filledWith(Medium{}));
  btRigidBody& body =
      fluid.add(tumblingBody(Vector3::Zero()), meshedEllipsoid(kUnequalAxes, 1), water());
  btRigidBody& dry = stock.add(tumblingBody(Vector3::Zero()));
  fluid.step(kWorldStep, 30);
  stock.step(kWorldStep, 30);
  EXPECT_TRUE(isSame(body, dry));
  EXPECT_EQ(fluid.registry.inertia(body)(5, 5), 2);  // its mass alone
}

TEST(FluidRegions, AWindZoneBlowsInsideOnly) {
  FluidWorld fluid;
  FluidRegion zone = filledWith(blowing({0, 5, 0}));
  zone.bounds = RegionBounds{{0, -kFar, -kFar}, {10, kFar, kFar}};
  fluid.registry.addRegion(zone);
  BodyDef def = tumblingBody({5, 0, 0});
  def.start.twist = {};
  const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
  btRigidBody& inside = fluid.add(def, shape, air());
  def.start.position.x() = 11;
  btRigidBody& outside = fluid.add(def, shape, air());
  fluid.step(kWorldStep, 120);
  EXPECT_GT(inside.getLinearVelocity().y(), bt(0.1));
  EXPECT_EQ(outside.getLinearVelocity().y(), bt(0));
}

// What a rigid rotation of the fluid does to a body of its density without faces: it stays on its
// circle, for the acceleration of the fluid acts on displaced and added mass alike.
double driftOnCircle(double step) {
  const double kRate = 1.2;
  FluidWorld fluid;
  FluidRegion whirl = filledWith(idealFluid(1000));
  whirl.flow = [=](const Vector3& x, double) {
    return FlowSample{kRate * Vector3(-x.y(), x.x(), 0), -kRate * kRate * Vector3(x.x(), x.y(), 0)};
  };
  fluid.registry.addRegion(whirl);
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.1));
  BodyDef def{1000 * shape.volume, Vector3::Constant(0.02), {}, nullptr};
  def.start.position = {2, 0, 0};
  def.start.twist.linear = {0, 2 * kRate, 0};
  const btRigidBody& body = fluid.add(def, shape, Medium{});
  const int steps = static_cast<int>(std::lround(4 / step));
  fluid.step(step, steps);
  const Vector3 exact(2 * std::cos(4 * kRate), 2 * std::sin(4 * kRate), 0);
  return (toVector3(body.getWorldTransform().getOrigin()) - exact).norm();
}

TEST(FluidRegions, ABodyOfTheFluidsDensityGoesWithAWhirl) {
  const double coarse = driftOnCircle(1.0 / 60), fine = driftOnCircle(1.0 / 120);
  EXPECT_LT(fine, 0.1);
  EXPECT_NEAR(coarse / fine, 2, 0.1);  // first order: the flow is sampled where a step begins
}

TEST(FluidRegions, FlowsSeeTheTimeOfTheWorldAtTheStartOfTheStep) {
  FluidWorld fluid;
  std::vector<double> times;
  FluidRegion region = filledWith(idealFluid(1));
  region.flow = [&](const Vector3&, double time) {
    times.push_back(time);
    return FlowSample{};
  };
  fluid.add(tumblingBody(Vector3::Zero()), facelessEllipsoid(kUnequalAxes), Medium{});
  fluid.step(0.25, 2);
  fluid.registry.addRegion(region);
  fluid.step(0.25, 2);
  EXPECT_EQ(times, (std::vector<double>{0.5, 0.75}));
  EXPECT_EQ(fluid.registry.time(), 1);
}

TEST(FluidRegions, AFlowThatIsNotFiniteIsDroppedAndCounted) {
  FluidWorld fluid;
  std::string said;
  fluid.registry.setReport([&](const std::string& sentence) { said += sentence; });
  FluidRegion region = filledWith(water());
  region.flow = [](const Vector3&, double) { return FlowSample{{std::nan(""), 0, 0}, {0, 0, 0}}; };
  fluid.registry.addRegion(region);
  const btRigidBody& body =
      fluid.add(tumblingBody(Vector3::Zero()), meshedEllipsoid(kUnequalAxes, 1), Medium{});
  fluid.step(kWorldStep, 5);
  EXPECT_EQ(fluid.registry.counters().rejected, 6);  // once when it was attached
  EXPECT_EQ(fluid.registry.medium(body).density, water().density);
  EXPECT_TRUE(toVector3(body.getWorldTransform().getOrigin()).allFinite());
  EXPECT_NE(said.find("flow or the surface of the region of fluid 0 is not finite"),
            std::string::npos);
}

TEST(FluidRegions, ARegionThatABodyCannotMeetChangesNothing) {
  FluidWorld fluid;
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid(kUnequalAxes));
  def.medium = idealFluid(7);
  def.flow.own_law = [](const std::shared_ptr<const FluidBody>&,
                        const LoadSettings& settings) -> std::shared_ptr<const SurfaceLoads> {
    if (settings.density > 100) throw std::invalid_argument("too dense");
    return nullptr;
  };
  btRigidBody& body = fluid.add(tumblingBody(Vector3::Zero()));
  fluid.registry.attach(body, def);
  const RegionId id = fluid.registry.addRegion(filledWith(idealFluid(8)));
  EXPECT_THROW(fluid.registry.addRegion(filledWith(water())), std::invalid_argument);
  EXPECT_THROW(fluid.registry.setRegion(id, filledWith(water())), std::invalid_argument);
  EXPECT_THROW(fluid.registry.setRegion(static_cast<RegionId>(7), filledWith(air())),
               std::invalid_argument);
  FluidRegion wrong = filledWith(air());
  wrong.below.density = -1;
  const auto expectSays = [](const auto& change, const char* sentence) {
    try {
      change();
      ADD_FAILURE() << "not refused: " << sentence;
    } catch (const std::invalid_argument& error) {
      EXPECT_STREQ(error.what(), sentence);
    }
  };
  expectSays([&] { fluid.registry.addRegion(wrong); },
             "region of fluid 1: density of the medium [kg/m^3] is -1; must be zero or positive "
             "and finite");
  expectSays([&] { fluid.registry.setRegion(id, wrong); },
             "region of fluid 0: density of the medium [kg/m^3] is -1; must be zero or positive "
             "and finite");
  fluid.step(kWorldStep);
  EXPECT_EQ(fluid.registry.medium(body).density, 8);
}

TEST(FluidRegions, OfTheirOwnMediumAndShapeBodiesInThemCanChange) {
  FluidWorld fluid;
  fluid.registry.addRegion(halfSpace(0, 0, idealFluid(8)));
  btRigidBody& body =
      fluid.add(tumblingBody({1, 0, 0}), facelessEllipsoid(kUnequalAxes), idealFluid(1));
  EXPECT_EQ(fluid.registry.medium(body).density, 8);  // since it was attached
  fluid.registry.setMedium(body, idealFluid(3));
  EXPECT_EQ(fluid.registry.medium(body).density, 8);
  const Matrix6 before = fluid.registry.inertia(body);
  fluid.registry.setFluidBody(body,
                              std::make_shared<FluidBody>(facelessEllipsoid(2 * kUnequalAxes)));
  EXPECT_GT(fluid.registry.inertia(body)(5, 5), before(5, 5) + 1);
  EXPECT_EQ(fluid.registry.medium(body).density, 8);
  body.setWorldTransform(btTransform(btQuaternion(0, 0, 0, 1), {-1, 0, 0}));
  fluid.step(kWorldStep);
  EXPECT_EQ(fluid.registry.medium(body).density, 3);
  Medium current = idealFluid(3);
  current.velocity = {0, 0, 1};
  fluid.registry.setMedium(body, current);
  EXPECT_EQ(fluid.registry.medium(body).velocity.z(), 1);
}

btRigidBody& addRestingBall(FluidWorld& fluid, const Medium& medium) {
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.2));
  BodyDef def{998 * shape.volume,
              ellipsoidMoments(Vector3::Constant(0.2), 998 * shape.volume),
              {},
              nullptr};
  btRigidBody& body = fluid.add(def, shape, medium);
  body.forceActivationState(ACTIVE_TAG);
  return body;
}

TEST(FluidRegions, BodiesSleepInAndWakeUpWhenTheyChange) {
  FluidWorld fluid;
  const RegionId id = fluid.registry.addRegion(filledWith(idealFluid(998)));
  const btRigidBody& body = addRestingBall(fluid, Medium{});
  fluid.step(1.0 / 60, 300);
  ASSERT_FALSE(body.isActive());
  FluidRegion current = filledWith(idealFluid(998));
  current.below.acceleration = {1, 0, 0};
  fluid.registry.setRegion(id, current);
  fluid.step(1.0 / 60, 2);
  EXPECT_TRUE(body.isActive());
  EXPECT_GT(body.getLinearVelocity().x(), bt(0));
}

TEST(FluidRegions, NobodySleepsInAFlowThatMayChange) {
  FluidWorld fluid;
  FluidRegion region = filledWith(idealFluid(998));
  region.flow = [](const Vector3&, double time) {
    return FlowSample{{0, 0, 0}, {time > 4 ? 1.0 : 0.0, 0, 0}};
  };
  fluid.registry.addRegion(region);
  const btRigidBody& body = addRestingBall(fluid, Medium{});
  fluid.step(1.0 / 60, 300);
  EXPECT_TRUE(body.isActive());
  EXPECT_GT(body.getLinearVelocity().x(), bt(0.9));
}

TEST(FluidRegions, NeverLookAtABodyThatIsGone) {
  FluidWorld fluid;
  auto body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(1, nullptr, nullptr, btVector3(1, 1, 1)));
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1));
  fluid.registry.attach(*body, def);
  body.reset();
  const RegionId id = fluid.registry.addRegion(filledWith(air()));
  fluid.step(kWorldStep);
  fluid.registry.setRegion(id, filledWith(water()));
  fluid.step(kWorldStep);
  EXPECT_TRUE(fluid.registry.removeRegion(id));
  fluid.step(kWorldStep);
}

TEST(FluidRegions, AreReachedThroughTheFluid) {
  Fluid<> fluid;
  FluidRegion region = filledWith(water());
  const RegionId id = fluid.addRegion(region);
  fluid.setRegion(id, filledWith(air()));
  EXPECT_TRUE(fluid.removeRegion(id));
}

TEST(FluidRegions, AWorldWithoutAnyAsksNothing) {
  FluidWorld fluid;
  fluid.add(tumblingBody(Vector3::Zero()), meshedEllipsoid(kUnequalAxes, 1), air());
  fluid.step(kWorldStep, 10);
  EXPECT_EQ(fluid.registry.counters().regions_asked, 0);
  EXPECT_EQ(fluid.registry.counters().medium_changes, 0);
  FluidRegion far_away = halfSpace(0, 1e6, water());
  fluid.registry.addRegion(far_away);
  fluid.registry.addRegion(far_away);
  fluid.step(kWorldStep, 10);
  EXPECT_EQ(fluid.registry.counters().regions_asked, 10);  // both are in one box
  EXPECT_EQ(fluid.registry.counters().medium_changes, 0);
}

}  // namespace
}  // namespace ambient::test
