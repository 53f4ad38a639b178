#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/robot_dynamics.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {
namespace {

// Which fluid is around the links of a robot, and what it does in it in the long run.

TEST_F(Robots, KnowTheirFluids) {
  btMultiBody& body = add();
  Fluid& fluid = world.fluid;
  const AttachDef def = fluidOf(body, 1);
  const Immersed link = fluid.add(body, 1, def);
  EXPECT_TRUE(fluid.find(body, 1));
  EXPECT_FALSE(fluid.find(body, 0));
  Matrix6 expected = def.fluid_body->added_mass;
  expected.diagonal().head<3>() += toVector3(body.getLinkInertia(1));
  expected.diagonal().tail<3>().array() += static_cast<double>(body.getLinkMass(1));
  EXPECT_LT((link.inertia() - expected).norm(), 1e-6 * expected.norm());
  fluid.find(body, 1)->setMedium(idealFluid(3));
  EXPECT_EQ(fluid.find(body, 1)->medium().density, 3);
  EXPECT_EQ(link.medium().density, 3);
  EXPECT_TRUE(link.remove());
  EXPECT_FALSE(link.remove());
  EXPECT_FALSE(fluid.find(body, 1));
}

class OneShape : public FluidBodySource {
 public:
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape&) override { return shape; }
  std::shared_ptr<const FluidBody> shape =
      std::make_shared<FluidBody>(facelessEllipsoid(Vector3(0.1, 0.1, 0.1)));
};

TEST_F(Robots, AreAttachedWithTheWorld) {
  RobotDef def;
  def.collider_radius = 0.05;
  btMultiBody& floating = add(def);
  def.has_fixed_base = true;
  btMultiBody& fixed = add(def);
  OneShape shapes;
  AttachSettings settings;
  settings.adjust_link = [&](const btMultiBody& body, int link, AttachDef& attach) {
    if (&body == &fixed && link == 2) attach.fluid_body = nullptr;
  };
  const AttachReport report = world.fluid.addAll(shapes, water(), settings);
  EXPECT_EQ(report.attached, 6);
  EXPECT_TRUE(report.refused.empty()) << report.text();
  const Fluid& fluid = world.fluid;
  EXPECT_TRUE(fluid.find(floating, -1));
  EXPECT_TRUE(fluid.find(fixed, 1));
  EXPECT_FALSE(fluid.find(fixed, 2));
  EXPECT_FALSE(fluid.find(fixed, -1));
  EXPECT_EQ(world.fluid.addAll(shapes, water(), settings).attached_before, 6);
}

// Water that is given 0.5 sin(2 pi t / 4 s) m/s in each step carries a neutral robot 0.637 m to and
// fro, docs/theory.md eq. (19a).
TEST_F(Robots, GoWithAFluidWhoseVelocityChanges) {
  constexpr double kRate = 2 * kPi / 4, kStep = 1.0 / 60;
  for (const int links : {0, 3}) {
    RobotWorld in;
    RobotDef still;
    still.links = links;
    still.speed = 0;
    btMultiBody& body = in.add(arbitrary, still);
    FluidRegion sea;
    sea.below = idealFluid(1000);
    const RegionId id = in.fluid.addRegion(sea);
    for (int link = -1; link < links; ++link) {
      FluidBody shape = facelessEllipsoid(Vector3(0.1, 0.1, 0.1));
      const btScalar mass = link < 0 ? body.getBaseMass() : body.getLinkMass(link);
      shape.volume = static_cast<double>(mass) / 1000;
      in.fluid.add(body, link, {std::make_shared<FluidBody>(shape)});
    }
    double least = 0, most = 0;
    const double start = static_cast<double>(body.getBasePos().x());
    for (int i = 0; i < 240; ++i) {
      sea.below.velocity.x() = 0.5 * std::sin(kRate * i * kStep);
      in.fluid.setRegion(id, sea);
      in.step(kStep);
      const double x = static_cast<double>(body.getBasePos().x()) - start;
      least = std::min(least, x);
      most = std::max(most, x);
    }
    EXPECT_NEAR(most - least, 2 * 0.5 / kRate, 1e-3) << links;
  }
}

TEST_F(Robots, SayOfTheirLinksWhatIsDoubtful) {
  btMultiBody& body = add();
  AttachDef def = fluidOf(body, 0);
  def.name = "arm";
  world.fluid.add(body, 0, def);
  EXPECT_TRUE(heard.empty()) << heard.front();
  def.flow.separation_angle = 2;
  world.fluid.add(body, 1, def);
  world.fluid.add(body, 2, def);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("body 'arm' has a separation angle"), std::string::npos) << heard[0];
}

// Links are light beside what they displace; a robot rises if all of it is.
TEST_F(Robots, AreLightAsAWhole) {
  world.world.setGravity({0, 0, bt(-9.81)});
  AttachDef def;
  FluidBody shape = facelessEllipsoid(Vector3(0.1, 0.1, 0.1));
  shape.name = "link";
  RobotDef heavy_base;
  btMultiBody& neutral = add(heavy_base);
  neutral.setBaseMass(50);
  btMultiBody& light = add(heavy_base);
  RobotDef on_the_ground;
  on_the_ground.has_fixed_base = true;
  btMultiBody& fixed = add(on_the_ground);
  double mass = static_cast<double>(light.getBaseMass());
  for (int i = 0; i < light.getNumLinks(); ++i) mass += static_cast<double>(light.getLinkMass(i));
  shape.volume = 0.9 * mass / 1000;  // of each of three links
  def.fluid_body = std::make_shared<FluidBody>(shape);
  def.medium = idealFluid(1000);
  for (int link = 0; link < 3; ++link) {
    world.fluid.add(neutral, link, def);
    world.fluid.add(fixed, link, def);
  }
  EXPECT_TRUE(heard.empty());
  for (int link = 0; link < 3; ++link) {
    EXPECT_TRUE(heard.empty()) << link;
    world.fluid.add(light, link, def);
  }
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("so that it rises"), std::string::npos) << heard[0];
}

TEST_F(Robots, ThatAreAttachedTogetherAreLightAsAWhole) {
  RobotDef def;
  def.collider_radius = 0.05;
  btMultiBody& light = add(def);
  light.setBaseMass(bt(1e-3));
  for (int i = 0; i < light.getNumLinks(); ++i) light.getLink(i).m_mass = bt(1e-3);
  OneShape shapes;
  world.world.setGravity({0, 0, bt(-9.81)});
  EXPECT_EQ(world.fluid.addAll(shapes, water()).attached, light.getNumLinks() + 1);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("so that it rises"), std::string::npos) << heard[0];
}

TEST_F(Robots, OfTheWorldAreAttachedByTheFilterOfLinks) {
  RobotDef def;
  def.collider_radius = 0.05;
  btMultiBody& floating = add(def);
  btMultiBody& other = add(def);
  OneShape shapes;
  AttachSettings settings;
  settings.filter_link = [&](const btMultiBody& body, int link) {
    return &body == &floating && link != 1;
  };
  EXPECT_EQ(world.fluid.addAll(shapes, water(), settings).attached, floating.getNumLinks());
  const Fluid& fluid = world.fluid;
  for (int link = -1; link < floating.getNumLinks(); ++link) {
    EXPECT_EQ(fluid.find(floating, link).has_value(), link != 1) << link;
    EXPECT_FALSE(fluid.find(other, link)) << link;
  }
}

// The loads of water on links that motors keep at rest, or not, as PyBullet's.
TEST_F(Robots, StayBoundedUnderMotorsInWater) {
  RobotDef def;
  def.links = 4;
  def.collider_radius = 0.05;
  def.speed = 3;
  btMultiBody& body = add(def);
  AttachDef attach{std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.15, 0.08, 0.05), 1)),
                   water()};
  for (int link = -1; link < 4; ++link) world.fluid.add(body, link, attach);
  for (int i = 0; i < 4; ++i)
    world.take(std::make_unique<btMultiBodyJointMotor>(&body, i, bt(0), bt(1e-3)));
  const Fluid& fluid = world.fluid;
  double last = kineticEnergy(fluid, body);
  const double start = last;
  for (int i = 0; i < 3600; ++i) {
    world.step(1 / 60.0);
    const double now = kineticEnergy(fluid, body);
    ASSERT_LT(now, 1.001 * last + 1e-9 * start) << "step " << i;
    last = now;
  }
  EXPECT_LT(last, 1e-3 * start);
}

// A barge that carries a load on a joint is let go aslant in calm water. Whatever holds the joint,
// its roll dies out as that of the same barge with the load welded on, however long the step.

const Vector3 kHull(6, 2.5, 1.2), kLoad(0.4, 0.4, 0.2);  // [m]
constexpr double kHullMass = 6300, kLoadMass = 100;      // [kg]
constexpr double kMass = kHullMass + kLoadMass;
constexpr double kLoadHeight = 0.7;         // above the middle of the hull [m]
constexpr double kRoll = 0.05 * kPi / 180;  // at the start [rad]
constexpr double kStrong = 1e6;             // impulse of a motor [N s]

enum class Load { kWelded, kFixed, kMotor, kPositionMotor, kLimits, kSwings };

// Returns the height of the centre of mass of the base above the middle of the hull [m].
double heightOfBase(Load load) {
  return load == Load::kWelded ? kLoadMass * kLoadHeight / kMass : 0;
}

std::unique_ptr<btMultiBody> weldedBarge() {
  const double height = heightOfBase(Load::kWelded), above = kLoadHeight - height;
  const double apart = kHullMass * height * height + kLoadMass * above * above;
  const btVector3 moments = toBullet(boxMoments(kHull, kHullMass)) +
                            toBullet(boxMoments(kLoad, kLoadMass)) +
                            btVector3(bt(apart), bt(apart), 0);
  return std::make_unique<btMultiBody>(0, bt(kMass), moments, false, false);
}

std::unique_ptr<btMultiBody> bargeWith(Load load) {
  if (load == Load::kWelded) return weldedBarge();
  auto body = std::make_unique<btMultiBody>(1, bt(kHullMass),
                                            toBullet(boxMoments(kHull, kHullMass)), false, false);
  const btVector3 moments = toBullet(boxMoments(kLoad, kLoadMass)), none(0, 0, 0), athwart(0, 1, 0);
  const btVector3 up(0, 0, bt(kLoadHeight)), hook(0, 0, bt(kLoadHeight + 1)), rope(0, 0, -1);
  const btQuaternion straight = btQuaternion::getIdentity();
  if (load == Load::kFixed) {
    body->setupFixed(0, bt(kLoadMass), moments, -1, straight, up, none);
  } else if (load == Load::kSwings) {
    body->setupRevolute(0, bt(kLoadMass), moments, -1, straight, {1, 0, 0}, hook, rope, true);
  } else {
    body->setupPrismatic(0, bt(kLoadMass), moments, -1, straight, athwart, up, none, true);
  }
  return body;
}

std::unique_ptr<btMultiBodyConstraint> rowsOf(Load load, btMultiBody& body) {
  if (load == Load::kLimits)
    return std::make_unique<btMultiBodyJointLimitConstraint>(&body, 0, bt(0), bt(0));
  if (load != Load::kMotor && load != Load::kPositionMotor) return nullptr;
  auto motor = std::make_unique<btMultiBodyJointMotor>(&body, 0, bt(0), bt(kStrong));
  if (load == Load::kPositionMotor) motor->setPositionTarget(0, bt(0.1));
  return motor;
}

class Barge {
 public:
  explicit Barge(Load load) : Barge(load, bargeWith(load)) {}

  /// Returns the largest tilt from `from` to `to` after the start [rad]; in s.
  double largestTilt(double from, double to, double hertz) {
    double largest = 0;
    for (; steps_ < to * hertz; ++steps_) {
      world_.step(1 / hertz);
      const btVector3 mast = quatRotate(body_.getWorldToBaseRot().inverse(), {0, 0, 1});
      if (steps_ >= from * hertz)
        largest = std::max(largest, static_cast<double>(std::hypot(mast.x(), mast.y())));
    }
    return largest;
  }

 private:
  Barge(Load load, std::unique_ptr<btMultiBody> robot) : body_(*robot) {
    world_.world.setGravity({0, 0, bt(-9.81)});
    world_.world.getSolverInfo().m_numIterations = 10;  // Bullet's default
    world_.fluid.addRegion(seaUnderAir());
    body_.setLinearDamping(0);
    body_.setAngularDamping(0);
    body_.setCanSleep(false);
    body_.finalizeMultiDof();
    const double draught = kMass / (water().density * kHull.x() * kHull.y());
    const double height = heightOfBase(load);
    body_.setBasePos({0, 0, bt(kHull.z() / 2 - draught + height)});
    body_.setWorldToBaseRot(btQuaternion(btVector3(1, 0, 0), bt(-kRoll)));
    // Bullet leaves out motors of links without a collider.
    world_.take(std::move(robot), 0.1);
    if (auto rows = rowsOf(load, body_)) world_.take(std::move(rows));
    AttachDef def{std::make_shared<FluidBody>(floatingBox(kHull)), air()};
    def.fluid_frame.translation = {0, 0, -height};
    world_.fluid.add(body_, -1, def);
  }

  RobotWorld world_;
  btMultiBody& body_;
  int steps_ = 0;
};

// Returns how fast the roll dies out in a minute [1/s].
double decayOf(Load load, double hertz) {
  constexpr double kMinute = 60, kWindow = 10;  // [s]
  Barge barge(load);
  const double first = barge.largestTilt(0, kWindow, hertz);
  const double last = barge.largestTilt(kMinute - kWindow, kMinute, hertz);
  return std::log(first / last) / (kMinute - kWindow);
}

TEST(RobotAfloat, RollsAsWithItsLoadWeldedOn) {
  for (const double hertz : {30.0, 60.0, 240.0}) {
    const double welded = decayOf(Load::kWelded, hertz);
    EXPECT_GT(welded, 0.09);
    for (const Load load : {Load::kFixed, Load::kMotor, Load::kPositionMotor, Load::kLimits})
      EXPECT_NEAR(decayOf(load, hertz) / welded, 1, 0.04)
          << hertz << " Hz, load " << static_cast<int>(load);
  }
}

// For ten minutes: rows that gained a little would roll it for ever.
TEST(RobotAfloat, LiesStillInTheEnd) {
  for (const Load load : {Load::kFixed, Load::kMotor, Load::kPositionMotor, Load::kLimits})
    EXPECT_LT(Barge(load).largestTilt(540, 600, 30), byPrecision(0.05, 1.0) * kRoll)
        << static_cast<int>(load);
}

TEST(RobotAfloat, RollsUnderASwingingLoadAsInShortSteps) {
  const double in_short_steps = decayOf(Load::kSwings, 480);
  for (const double hertz : {30.0, 60.0})
    EXPECT_NEAR(decayOf(Load::kSwings, hertz) / in_short_steps, 1, 0.03) << hertz << " Hz";
}

}  // namespace
}  // namespace ambient::test
