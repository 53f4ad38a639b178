#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/reading.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/vessel_bodies.h"

// Links at the surface of water float as bodies do.
namespace ambient::test {
namespace {

constexpr double kSurfaceHertz = 240;

struct Weather {
  double wave = 0;  ///< amplitude of waves of 3 s [m]
  double wind = 0;  ///< along x [m/s]
};

btTransform offBalance() {
  return btTransform(btQuaternion(btVector3(1, bt(0.5), 0), bt(0.3)), {0, 0, bt(0.05)});
}

/// A floating box, half as dense as water, at rest.
struct Floater {
  FluidBody shape = floatingBox({0.4, 0.4, 0.2});
  double specific_gravity = 0.5;
  Vector3 gyration_squared{0.2 / 12, 0.2 / 12, 0.32 / 12};  ///< [m^2]
  Twist twist_W;
  int max_substeps = 0;  ///< FlightSettings
  HoldSettings holds;
};

/// A floater as a rigid body and as a multibody without links. Neither collides. Both are let go at
/// one place.
class FloatingPair {
 public:
  explicit FloatingPair(const Weather& weather, const btTransform& place = offBalance(),
                        Floater what = {})
      : floater(std::move(what)) {
    world.world.setGravity({0, 0, bt(-9.81)});
    FluidRegion sea = seaUnderAir();
    sea.above->velocity = {weather.wind, 0, 0};
    if (weather.wave != 0)
      sea.surface = std::make_shared<AiryWaves>(
          CalmSea{}, std::vector<WaveComponent>{{weather.wave, 3, {1, 0, 0}, 0}});
    world.fluid.addRegion(sea);
    rigid.setWorldTransform(place);
    rigid.setActivationState(DISABLE_DEACTIVATION);
    world.world.addRigidBody(&rigid);
    multi.setLinearDamping(0);
    multi.setAngularDamping(0);
    multi.setCanSleep(false);
    multi.finalizeMultiDof();
    multi.setBasePos(place.getOrigin());
    multi.setWorldToBaseRot(place.getRotation().inverse());
    world.world.addMultiBody(&multi);
    const btVector3 spin = toBullet(floater.twist_W.angular),
                    velocity = toBullet(floater.twist_W.linear);
    rigid.setAngularVelocity(spin);
    rigid.setLinearVelocity(velocity);
    multi.setBaseOmega(spin);
    multi.setBaseVel(velocity);
    AttachDef def{std::make_shared<FluidBody>(floater.shape), air()};
    def.flight.max_substeps = floater.max_substeps;
    def.holds = floater.holds;
    world.fluid.add(rigid, def);
    world.fluid.add(multi, -1, def);
  }
  ~FloatingPair() {
    world.world.removeMultiBody(&multi);
    world.world.removeRigidBody(&rigid);
  }

  /// Largest distance of the two in `seconds`, of centres or of corners by their turn [m].
  double distanceIn(double seconds, double hertz = kSurfaceHertz) {
    double largest = 0;
    for (int i = 0; i < seconds * hertz; ++i) {
      world.step(1 / hertz);
      const btTransform& a = rigid.getWorldTransform();
      const btTransform b = multi.getBaseWorldTransform();
      const btQuaternion turn = a.getRotation() * b.getRotation().inverse();
      const btVector3 axis(turn.x(), turn.y(), turn.z());
      const btScalar distance = (a.getOrigin() - b.getOrigin()).length();
      largest = std::max(largest, static_cast<double>(distance + axis.length()));
    }
    return largest;
  }

  const Floater floater;
  const double mass = floater.specific_gravity * water().density * floater.shape.volume;
  const btVector3 inertia = bt(mass) * toBullet(floater.gyration_squared);
  RobotWorld world;
  btEmptyShape no_shape;
  btRigidBody rigid{
      btRigidBody::btRigidBodyConstructionInfo(bt(mass), nullptr, &no_shape, inertia)};
  btMultiBody multi{0, bt(mass), inertia, false, false};
};

/// A barge of 200 kg with 0.2 m^3 of water, and a hole of an area in its floor [m^2].
Floater bargeWithWater(double hole) {
  OpenBarge barge;
  barge.hole = hole;
  return {openBarge(barge), 0.2, {0.13, 0.42, 0.5}, {}, 0, {true, {0.2}}};
}

// Its water pushes a link once a step, a body in two halves.
TEST(LinksAtASurface, SloshAsABody) {
  const btTransform heeled(btQuaternion(btVector3(1, 0, 0), bt(0.05)), {0, 0, bt(0.05)});
  FloatingPair pair({}, heeled, bargeWithWater(0));
  EXPECT_LT(pair.distanceIn(5), 0.01);
}

TEST(LinksAtASurface, SinkAsABody) {
  FloatingPair pair({}, btTransform(btQuaternion::getIdentity(), {0, 0, bt(0.05)}),
                    bargeWithWater(0.02));
  EXPECT_LT(pair.distanceIn(10), 0.01);
  const double in_body = pair.world.fluid.find(pair.rigid)->holds().at(0).volume;
  const double in_link = pair.world.fluid.find(pair.multi, -1)->holds().at(0).volume;
  EXPECT_GT(in_body, 0.25);
  EXPECT_NEAR(in_link, in_body, 1e-3);
}

/// A toy boat of 4.5 kg let go over the water in the hold of a barge; each is a link or a body.
/// Returns the heights of both after ten seconds [m].
std::pair<double, double> toyInABarge(bool is_link, bool is_in_link) {
  btEmptyShape no_shape;
  RobotWorld world;
  world.world.setGravity({0, 0, bt(-9.81)});
  world.fluid.addRegion(seaUnderAir());
  std::vector<std::function<double()>> heights;
  const auto add = [&](const Floater& floater, double height, bool as_link) {
    const double mass = floater.specific_gravity * water().density * floater.shape.volume;
    const btVector3 inertia = bt(mass) * toBullet(floater.gyration_squared);
    AttachDef def{std::make_shared<FluidBody>(floater.shape), air()};
    def.holds = floater.holds;
    if (as_link) {
      auto robot = std::make_unique<btMultiBody>(0, bt(mass), inertia, false, false);
      robot->finalizeMultiDof();
      robot->setBasePos({0, 0, bt(height)});
      btMultiBody& multi = world.takeUndamped(std::move(robot));
      world.fluid.add(multi, -1, def);
      heights.emplace_back([&multi] { return static_cast<double>(multi.getBasePos().z()); });
    } else {
      btRigidBody& rigid = world.contents.add(
          mass, inertia, no_shape, btTransform(btQuaternion::getIdentity(), {0, 0, bt(height)}));
      rigid.setActivationState(DISABLE_DEACTIVATION);
      world.fluid.add(rigid, def);
      heights.emplace_back(
          [&rigid] { return static_cast<double>(rigid.getWorldTransform().getOrigin().z()); });
    }
  };
  Floater toy;
  toy.shape = floatingBox({0.3, 0.3, 0.1});
  toy.gyration_squared = {0.1 / 12, 0.1 / 12, 0.18 / 12};
  add(bargeWithWater(0), 0.05, is_in_link);
  add(toy, 0.1, is_link);
  world.step(1 / kSurfaceHertz, static_cast<int>(10 * kSurfaceHertz));
  return {heights[0](), heights[1]()};
}

TEST(LinksAtASurface, FloatInAHoldAsBodiesDo) {
  const auto [barge, toy] = toyInABarge(false, false);
  EXPECT_LT(toy, -0.01);  // the level in the hold lies below that of the sea
  for (const bool is_in_link : {false, true}) {
    const auto [barge_there, toy_there] = toyInABarge(true, is_in_link);
    EXPECT_NEAR(barge_there, barge, 1e-3);
    EXPECT_NEAR(toy_there, toy, 1e-3);
  }
}

TEST(LinksAtASurface, RideWavesAsABody) {
  FloatingPair pair({0.1, 0});
  EXPECT_LT(pair.distanceIn(20), byPrecision(1e-6, 1e-2));
}

// Deep in the water and at its surface, after a step.
TEST(LinksAtASurface, ReadAsABody) {
  Floater what;
  what.shape = floatingEllipsoid(kUnequalAxes, 2);
  what.gyration_squared = ellipsoidMoments(kUnequalAxes, 1);
  what.twist_W.linear = {0.5, 0.2, -0.4};
  for (const double height : {-2.0, 0.05}) {
    FloatingPair pair({}, btTransform(offBalance().getRotation(), {0, 0, bt(height)}), what);
    const Immersed link = *pair.world.fluid.find(pair.multi, -1),
                   body = *pair.world.fluid.find(pair.rigid);
    link.readWrench(true);
    body.readWrench(true);
    pair.world.step(1 / kSurfaceHertz);
    const FluidWrench of_link = link.wrench(), of_body = body.wrench();
    const double size = of_body.buoyancy.force.norm();
    for (const auto part : {&FluidWrench::pressure, &FluidWrench::friction, &FluidWrench::buoyancy,
                            &FluidWrench::waves, &FluidWrench::added_mass})
      EXPECT_LT(((of_link.*part).vector() - (of_body.*part).vector()).norm(), 2e-3 * size)
          << height;  // two means of one way
    EXPECT_EQ(of_link.constraints.vector().norm(), 0);
  }
}

// To rounding for 5 s. Later the two take different numbers of substeps, for rounding, and drift
// apart.
TEST(LinksAtASurface, DriftInWindAsABody) {
  FloatingPair pair({0, 10});
  EXPECT_LT(pair.distanceIn(5), byPrecision(1e-11, 1e-2));
  EXPECT_LT(pair.distanceIn(1), byPrecision(1e-6, 1e-2));
  EXPECT_GT(pair.rigid.getWorldTransform().getOrigin().x(), bt(0.1));
}

// A chip of 1.3 cm, 0.035 times as dense as water, at steps of 25 ms: it would fall deeper than its
// energy reaches, and two substeps are too few to see it. It ends such a step early, as a body
// does.
TEST(LinksAtASurface, HaltAsABody) {
  Floater chip;
  chip.shape = floatingEllipsoid({0.0065, 0.0013, 0.00065}, 1);
  chip.specific_gravity = 0.035;
  chip.gyration_squared = Vector3::Constant(0.005 * 0.005);
  chip.twist_W = {{2, 5, -6}, {0, 0, -0.5}};
  chip.max_substeps = 2;
  FloatingPair pair({}, btTransform(btQuaternion::getIdentity(), {0, 0, bt(0.03)}), chip);
  pair.distanceIn(30 * 0.025, 1 / 0.025);
  const AmbientCounters of_rigid = pair.world.fluid.find(pair.rigid)->counters(),
                        of_multi = pair.world.fluid.find(pair.multi, -1)->counters();
  EXPECT_GT(of_rigid.halted, 0);
  EXPECT_GT(of_multi.halted, 0);
  EXPECT_GT(of_multi.energy_removed, 0);
  // Nothing that floats so light leaves the water's surface by more than it fell.
  EXPECT_LT(std::abs(static_cast<double>(pair.multi.getBasePos().z())), 0.03);
}

// A cube of 1 cm, a tenth as dense as water, as a multibody on a rail that allows vertical motion
// only, at rest at a height of its centre.
struct LinkOnRail {
  explicit LinkOnRail(double height) {
    world.world.setGravity({0, 0, bt(-kGravity)});
    world.fluid.addRegion(seaUnderAir());
    auto robot = std::make_unique<btMultiBody>(0, bt(kMass), inertia(), false, false);
    robot->finalizeMultiDof();
    robot->setBasePos({0, 0, bt(height)});
    cube = &world.takeUndamped(std::move(robot), 0.1 * kEdge);
    const btMatrix3x3 frame = btMatrix3x3::getIdentity();
    const btVector3 zero(0, 0, 0);
    world.take(std::make_unique<btMultiBodySliderConstraint>(cube, -1, nullptr, zero, zero, frame,
                                                             frame, btVector3(0, 0, 1)));
    AttachDef def{std::make_shared<FluidBody>(floatingBox(Vector3::Constant(kEdge))), air()};
    def.fluid_frame.translation.x() = 0.05 * kEdge;  // else the rail has nothing to hold
    world.fluid.add(*cube, -1, def);
  }
  bool isInAir() const { return cube->getBasePos().z() > bt(kEdge / 2); }
  // Energy without that of the water that moves, over rho g a^4.
  double leastEnergy() const {
    const double z = static_cast<double>(cube->getBasePos().z());
    const double v = static_cast<double>(cube->getBaseVel().z());
    const double draught = std::clamp(kEdge / 2 - z, 0.0, kEdge);
    const double centre = draught < kEdge ? draught / 2 : -z;  // of the wet part, below the surface
    const double lift = 1000 * kGravity * kEdge * kEdge * draught;
    return (kMass * (v * v / 2 + kGravity * z) + lift * centre) /
           (1000 * kGravity * kEdge * kEdge * kEdge * kEdge);
  }
  static btVector3 inertia() { return btVector3(1, 1, 1) * bt(kMass * kEdge * kEdge / 6); }

  static constexpr double kEdge = 0.01, kMass = 1e-4, kGravity = 9.81;
  RobotWorld world;
  btMultiBody* cube = nullptr;
};

// Neither leaps out with more than it had nor falls deeper than its energy reaches, eq. (68c). In
// float it gains 0.018 at 60 Hz and 0.050 at 240 Hz.
TEST(LinksAtASurface, OnARailGainNoEnergy) {
  for (const double hertz : {60.0, 240.0}) {
    double most = 0;
    for (int depth = 0; depth < 26; ++depth) {
      LinkOnRail link(-LinkOnRail::kEdge * (0.5 + 0.1 * depth));
      double had = link.leastEnergy();  // in the air that is all
      for (int i = 0; i < hertz; ++i) {
        link.world.step(1 / hertz);
        const double has = link.leastEnergy();
        most = std::max(most, has - had);
        if (link.isInAir()) had = std::min(had, has);
      }
      EXPECT_GT(link.world.fluid.find(*link.cube, -1)->counters().energy_removed, 0);
    }
    EXPECT_LT(most, byPrecision(0.01, 0.06)) << hertz << " Hz";
  }
}

TEST(LinksAtASurface, SleepInStillWaterButNotOnASaddle) {
  FloatingPair flat({}, btTransform(btQuaternion::getIdentity(), {0, 0, bt(0.001)}));
  FloatingPair on_its_side({}, btTransform(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI)));
  for (FloatingPair* pair : {&flat, &on_its_side}) {
    pair->multi.setCanSleep(true);
    pair->distanceIn(3);
  }
  EXPECT_FALSE(flat.multi.isAwake());
  EXPECT_TRUE(on_its_side.multi.isAwake());
}

// A barge of 3500 kg with a mast of 20 kg, which a motor holds, 0.06 m above its balance.
struct MotorBarge {
  explicit MotorBarge(double above) {
    world.world.setGravity({0, 0, bt(-9.81)});
    world.fluid.addRegion(seaUnderAir());
    barge.setLinearDamping(0);
    barge.setAngularDamping(0);
    barge.setupRevolute(0, 20, {5, 5, 1}, -1, btQuaternion::getIdentity(), {0, 0, 1},
                        {0, 0, bt(0.4)}, {0, 0, bt(0.4)}, true);
    barge.finalizeMultiDof();
    barge.setBasePos({0, 0, bt(kBalance + above)});
    world.world.addMultiBody(&barge);
    collider.setCollisionShape(&ball);
    barge.setBaseCollider(&collider);
    world.world.addCollisionObject(&collider);
    world.take(std::make_unique<btMultiBodyJointMotor>(&barge, 0, bt(0), bt(1)));
    world.fluid.add(barge, -1, {std::make_shared<FluidBody>(floatingBox({5, 2, 0.8}))});
  }
  ~MotorBarge() {
    world.world.removeCollisionObject(&collider);
    world.world.removeMultiBody(&barge);
  }
  /// Steps until the barge sleeps. Returns the time, 300 s at most.
  double timeUntilSleep() {
    for (int i = 0; i < 300 * 60; ++i) {
      if (!barge.isAwake()) return i / 60.0;
      world.step(1.0 / 60);
    }
    return 300;
  }
  double height() const { return static_cast<double>(barge.getBasePos().z()); }

  static constexpr double kBalance = 0.4 - 3520.0 / 9970;
  RobotWorld world;
  btMultiBody barge{1, 3500, {1353, 7478, 8458}, false, true};
  btSphereShape ball{bt(0.1)};
  btMultiBodyLinkCollider collider{&barge, -1};
};

TEST(LinksAtASurface, SleepAtTheirBalanceWithAMotor) {
  MotorBarge boat(0.06);
  const double slept = boat.timeUntilSleep();
  EXPECT_GT(slept, 4);
  EXPECT_LT(slept, 290);
  EXPECT_NEAR(boat.height(), MotorBarge::kBalance, 0.01);
}

TEST(LinksAtASurface, WakeWhereALinkIsLoaded) {
  MotorBarge boat(0);
  ASSERT_LT(boat.timeUntilSleep(), 290);
  boat.world.step(1.0 / 60, 10);
  ASSERT_FALSE(boat.barge.isAwake());
  boat.barge.setBaseMass(3850);
  boat.world.step(1.0 / 60);
  EXPECT_TRUE(boat.barge.isAwake());
  EXPECT_LT(boat.timeUntilSleep(), 290);
  EXPECT_NEAR(boat.height(), MotorBarge::kBalance - 350 / 9970.0, 0.01);
}

// Wind takes one evaluation of the loads on the dry part in each step; without wind there is none.
TEST(LinksAtASurface, PayForWindWhereItBlows) {
  FloatingPair calm({}), windy({0, 10});
  for (FloatingPair* pair : {&calm, &windy}) pair->distanceIn(0.25);
  const auto evaluations = [](const FloatingPair& pair) {
    return pair.world.fluid.find(pair.multi, -1)->counters().load_evaluations;
  };
  EXPECT_GT(evaluations(calm), 60);
  EXPECT_GT(evaluations(windy), evaluations(calm) + 60);
}

}  // namespace
}  // namespace ambient::test
