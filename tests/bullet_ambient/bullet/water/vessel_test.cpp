#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/motion/surface/stand_lanes.h"
#include "bullet_ambient/saved_state.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/vessel_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/runs.h"

// A barge of 2 x 1 x 0.5 m with walls of 2 cm and 200 kg afloat in water of 1000 kg/m^3.
namespace ambient::test {
namespace {

constexpr double kAtmosphere = 101325;
constexpr double kBarge = 200, kCapacity = 1.96 * 0.96 * 0.48;
const Vector3 kBargeMoments = kBarge * Vector3(0.13, 0.42, 0.5);

struct Start {
  Vector3 position{0, 0, 0.15};  ///< of the middle of the closed box [m]
  Quaternion orientation = Quaternion::Identity();
  Twist twist{};             ///< world axes
  double above_keel = 0.13;  ///< of the centre of mass [m]
  double mass = kBarge;      ///< [kg]
};

struct Sea {
  explicit Sea(std::shared_ptr<const WaterSurface> surface =
                   std::make_shared<StillWater>(0.0, Vector3(0, 0, 1))) {
    scene.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    scene.world.setGravity({0, 0, bt(-kGravity)});
    FluidRegion sea;
    sea.below = {1000, 1e-3, {0, 0, 0}, {0, 0, 0}};
    sea.above = Medium{};
    sea.surface = std::move(surface);
    scene.fluid.addRegion(sea);
  }
  btRigidBody& add(const OpenBarge& barge, const Start& start, const HoldSettings& holds = {}) {
    const Vector3 centre(0, 0, start.above_keel - 0.25);
    BodyDef def{start.mass, start.mass / kBarge * kBargeMoments, {}, nullptr};
    def.start.position = start.position + start.orientation * centre;
    def.start.orientation = start.orientation;
    def.start.twist = start.twist;
    btRigidBody& body = scene.add(def);
    AttachDef attach;
    attach.fluid_body = std::make_shared<FluidBody>(openBarge(barge));
    attach.fluid_frame.translation = -centre;
    attach.holds = holds;
    scene.fluid.add(body, attach);
    return body;
  }
  const AmbientBody& of(const btRigidBody& body) const {
    return *membersOf(scene.fluid).find(&body);
  }
  double water(const btRigidBody& body) const { return of(body).vessel->holds[0].volume; }
  /// Energy of the body, the water around and that in its holds, docs/theory.md eq. (64) [J].
  double energy(const btRigidBody& body, double mass = kBarge) const {
    const AmbientBody& ambient = of(body);
    const SurfaceModel& model = ambient.models->surfaces.at(0).model;
    const RigidState state = readState(body);
    const SurfacePlane still{{0, 0, 1}, 0, 1000, kGravity};
    WaterInside inside;
    const SurfaceStand stand =
        standAtSurface(model, seenFrom(still, state.orientation.toRotationMatrix(), state.position),
                       {waterOf(ambient), &inside});
    const Vector6 x = state.twist.vector();
    return x.dot(stand.inertia.full() * x) / 2 + mass * kGravity * state.position.z() +
           hydrostaticEnergy(wetVolume(model, stand), stand.plane) +
           ambient.floating->waves.energy() + energyOfAirIn(ambient);
  }

  /// Energy of the air that water shuts off, docs/theory.md eq. (148) [J].
  static double energyOfAirIn(const AmbientBody& ambient) {
    const VesselState& vessel = *ambient.vessel;
    double energy = 0;
    for (std::size_t i = 0; i < vessel.holds.size(); ++i) {
      const HoldState& hold = vessel.holds[i];
      const double room = vessel.shape->holds[i].volume - hold.volume;
      if (hold.is_sealed) energy += energyOfAir(hold.air, room, kAtmosphere);
    }
    return energy;
  }

  FluidWorld scene;
};

/// Height of the middle of the box [m].
double middleOf(const btRigidBody& body, double above_keel = 0.13) {
  return static_cast<double>(body.getWorldTransform().getOrigin().z()) + 0.25 - above_keel;
}

/// A joint that lets a body move up and down, and roll, within limits [m, rad].
struct Rail {
  Rail(Sea& sea, btRigidBody& body, double lift, double roll)
      : world(sea.scene.world), joint(body, btTransform(btQuaternion::getIdentity()), false) {
    joint.setLinearLowerLimit({0, 0, bt(-lift)});
    joint.setLinearUpperLimit({0, 0, bt(lift)});
    joint.setAngularLowerLimit({bt(-roll), 0, 0});
    joint.setAngularUpperLimit({bt(roll), 0, 0});
    world.addConstraint(&joint, true);
  }
  ~Rail() { world.removeConstraint(&joint); }

  btDynamicsWorld& world;
  btGeneric6DofConstraint joint;
};

double heelOf(const btRigidBody& body) {
  return std::acos(std::min(1.0, static_cast<double>(body.getWorldTransform().getBasis()[2].z())));
}

/// Steps a barge with a hole of 0.01 m^2 in its floor until its rim dips. Returns the time [s].
double timeToDip(Sea& sea, const btRigidBody& body, double hertz) {
  double time = 0;
  while (middleOf(body) > -0.25 && time < 200) {
    sea.scene.step(1 / hertz);
    time += 1 / hertz;
  }
  return time;
}

/// Head D = D0 - c V, c = 1/A_i - 1/A_o: 2 (sqrt D0 - sqrt(D0 - c V)) / (C a sqrt(2g) c), V 0.8
/// m^3.
double exactTimeToDip() {
  const double c = 1 / (1.96 * 0.96) - 1 / 2.0, D0 = 0.08;
  return 2 * (std::sqrt(D0) - std::sqrt(D0 - c * 0.8)) / (0.6 * 0.01 * std::sqrt(2 * kGravity) * c);
}

TEST(Vessel, BargeWithAHoleSinksInItsTime) {
  Sea sea;
  OpenBarge barge;
  barge.hole = 0.01;
  btRigidBody& body = sea.add(barge, {});
  EXPECT_EQ(sea.water(body), 0);
  const double exact = exactTimeToDip();
  EXPECT_NEAR(exact, 116.447, 1e-3);
  EXPECT_NEAR(timeToDip(sea, body, 60), exact, 0.003 * exact);
  EXPECT_NEAR(sea.water(body), 0.8, 0.01);
  EXPECT_LT(heelOf(body), 0.01);
  sea.scene.step(1 / 60.0, 300);
  EXPECT_DOUBLE_EQ(sea.water(body), kCapacity);
  EXPECT_LT(middleOf(body), -1);
  const HoldWater hold = sea.scene.fluid.find(body)->holds().at(0);
  EXPECT_NEAR(hold.flooded - hold.drained, kCapacity, 1e-9);
  // Far below it is a body of walls in one fluid.
  sea.scene.step(1 / 60.0, 300);
  EXPECT_EQ(sea.of(body).surface(), nullptr);
}

// Rows move it.
TEST(Vessel, BargeOnARailSinksInTheSameTime) {
  Sea sea;
  OpenBarge barge;
  barge.hole = 0.01;
  btRigidBody& body = sea.add(barge, {});
  Rail rail(sea, body, 5, 0);
  const double exact = exactTimeToDip();
  EXPECT_NEAR(timeToDip(sea, body, 60), exact, 0.003 * exact);
}

TEST(Vessel, TopHeavyBargeWithWaterLolls) {
  Sea sea;
  Start start;
  start.above_keel = 0.2385;
  start.position = {0, 0, 0.05};
  start.orientation = rotationFromVector(Vector3(0.11, 0, 0));
  btRigidBody& body = sea.add({}, start, {true, {0.2}});
  sea.scene.step(1 / 60.0, 60 * 300);
  double mean = 0;
  constexpr int kSteps = 60 * 500;  // some five periods
  for (int i = 0; i < kSteps; ++i) {
    sea.scene.step(1 / 60.0);
    mean += heelOf(body) * 180 / kPi / kSteps;
  }
  EXPECT_NEAR(mean, 7.05, 0.1);
}

TEST(Vessel, EnergyNeverGrowsInCalmWater) {
  Arbitrary arbitrary(11);
  for (int i = 0; i < 16; ++i) {
    const double hertz = std::array{30.0, 60.0, 120.0, 240.0}[static_cast<std::size_t>(i) % 4];
    Sea sea;
    Start start;
    start.position.z() = arbitrary.between(-0.3, 0.3);
    start.orientation = rotationFromVector(0.5 * arbitrary.vector().normalized());
    start.twist = {arbitrary.vector().normalized(), arbitrary.vector().normalized()};
    OpenBarge barge;
    barge.holds = 1 + i % 2;
    barge.door = 0.01;
    barge.hole = i % 3 == 0 ? 0.01 : 0;
    const double room = kCapacity / barge.holds * 0.95;
    std::vector<double> water;
    for (int hold = 0; hold < barge.holds; ++hold)
      water.push_back(room * arbitrary.between(0.02, 0.98));
    btRigidBody& body = sea.add(barge, start, {i >= 4, water});
    sea.scene.step(1 / hertz);
    double energy = sea.energy(body);
    for (int k = 0; k < 400; ++k) {
      sea.scene.step(1 / hertz);
      const double next = sea.energy(body);
      EXPECT_LT(next - energy, byPrecision(1e-9, 3e-6) * kBarge * kGravity) << i << ' ' << k;
      energy = next;
    }
  }
}

/// Turned over about x.
Start capsized() {
  Start start;
  start.orientation = rotationFromVector(Vector3(kPi, 0, 0));
  return start;
}

// Energies of air are up to 91 kJ: their rounding counts where poses are floats.
TEST(Vessel, EnergyNeverGrowsWhereWaterShutsOffAir) {
  Arbitrary arbitrary(12);
  int sealed = 0;
  for (int i = 0; i < 16; ++i) {
    const double hertz = std::array{30.0, 60.0, 120.0, 240.0}[static_cast<std::size_t>(i) % 4];
    Sea sea;
    Start start = capsized();
    start.position.z() = arbitrary.between(-1, 0.3);
    start.orientation = rotationFromVector(arbitrary.vector().normalized()) * start.orientation;
    start.twist = {arbitrary.vector().normalized(), arbitrary.vector().normalized()};
    start.mass = arbitrary.between(150, 1500);
    OpenBarge barge;
    barge.holds = 1 + i % 2;
    barge.door = i % 4 < 2 ? 0.01 : 0;
    btRigidBody& body = sea.add(barge, start, {true, std::vector<double>(barge.holds, 0.05)});
    sea.scene.step(1 / hertz);
    double energy = sea.energy(body, start.mass);
    for (int k = 0; k < 400; ++k) {
      sea.scene.step(1 / hertz);
      const double next = sea.energy(body, start.mass);
      sealed += sea.of(body).vessel->holds[0].is_sealed;
      EXPECT_LT(next - energy, byPrecision(1e-9, 3e-6) * start.mass * kGravity) << i << ' ' << k;
      energy = next;
    }
  }
  EXPECT_GT(sealed, 2000);
}

/// Column of air in a room of a depth L whose mouth is under by d: p_0 L = (p_0 + rho g (d - L +
/// x)) x.
double airColumn(double mouth, double room) {
  const double head = kAtmosphere / (1000 * kGravity), b = head + mouth - room;
  return (std::sqrt(b * b + 4 * head * room) - b) / 2;
}

// A bell sinks on its rail to its stop.
TEST(Vessel, DivingBellKeepsItsAirUnderPressure) {
  for (const double hertz : {30.0, 60.0, 240.0}) {
    Sea sea;
    Start start = capsized();
    start.position.z() = 1;
    start.mass = 2000;
    btRigidBody& body = sea.add({}, start);
    Rail rail(sea, body, 4, 0);
    sea.scene.step(1 / hertz, static_cast<int>(20 * hertz));
    const double mouth = 0.25 - middleOf(body, 0.37);
    EXPECT_NEAR(mouth, 3.25, 0.01);
    const HoldWater hold = sea.scene.of(body).holds().at(0);
    EXPECT_TRUE(hold.has_trapped_air);
    const double column = airColumn(mouth, 0.48);
    EXPECT_NEAR(hold.capacity - hold.volume, 1.96 * 0.96 * column, byPrecision(1e-6, 1e-4))
        << hertz;
    EXPECT_NEAR(hold.air_pressure, kAtmosphere * 0.48 / column, byPrecision(1, 30));
    EXPECT_NEAR(hold.flooded - hold.drained, hold.volume, 1e-9);
  }
}

// With a rim at a depth T and water up to w in it: m / rho = L B T - A w, and its air by Boyle.
TEST(Vessel, BoatThatTurnsOverFloatsOnItsAir) {
  double low = 0, high = 0.5, rim = 0, water = 0;
  for (int i = 0; i < 100; ++i) {
    rim = (low + high) / 2;
    water = 0.48 - airColumn(rim, 0.48);
    (2 * rim - 1.96 * 0.96 * water < 0.2 ? low : high) = rim;
  }
  for (const double hertz : {30.0, 60.0, 240.0}) {
    Sea sea;
    Start start = capsized();
    start.above_keel = 0.42;
    start.position.z() = 0.15;
    btRigidBody& body = sea.add({}, start);
    sea.scene.step(1 / hertz, static_cast<int>(120 * hertz));
    EXPECT_GT(heelOf(body), kPi - 0.01) << hertz;
    EXPECT_NEAR(0.25 - middleOf(body, 0.08), rim, 1e-3) << hertz;
    EXPECT_NEAR(sea.water(body), 1.96 * 0.96 * water, 1e-3) << hertz;
  }
}

// Pushed 1.2 m under and let go: mouth down it comes up again, mouth up it fills and sinks.
TEST(Vessel, BowlThatIsPushedUnderComesUpOrSinks) {
  for (const bool is_down : {true, false}) {
    Sea sea;
    Start start;
    if (is_down) start = capsized();
    start.position.z() = -1.2;
    start.above_keel = 0.42;
    btRigidBody& body = sea.add({}, start, {true, {0}});
    sea.scene.step(1 / 60.0, 60);
    if (is_down) {
      EXPECT_LT(sea.water(body), 0.25 * kCapacity);
      sea.scene.step(1 / 60.0, 240);
      EXPECT_GT(middleOf(body, 0.08), 0);
    } else {
      EXPECT_EQ(sea.water(body), kCapacity);
      sea.scene.step(1 / 60.0, 240);
      EXPECT_LT(middleOf(body, 0.42), -2.5);
    }
  }
}

// A closed barge takes in its own mass of water in one step: it keeps its momentum.
TEST(Vessel, WaterThatComesInWasAtRest) {
  Sea sea;
  Start start;
  start.twist.linear = {0.1, 0, 0};
  btRigidBody& body = sea.add({}, start, {false, {}});
  const Immersed barge = sea.scene.of(body);
  sea.scene.step(1 / 60.0);
  const auto momentum = [&] {
    return barge.inertia()(3, 3) * static_cast<double>(body.getLinearVelocity().x());
  };
  const double before = momentum();
  barge.pump(0, 0.2 * 60);
  sea.scene.step(1 / 60.0);
  const auto step = static_cast<double>(btScalar(1 / 60.0));  // as Bullet has it
  EXPECT_NEAR(sea.water(body), 0.2 * 60 * step, 1e-12);
  EXPECT_NEAR(momentum(), before, 0.01 * before);
}

// Waves wash over the rim of a barge that is held and rolls, in and out.
TEST(Vessel, WavesNeitherMakeNorLoseWater) {
  const std::vector<WaveComponent> waves{{0.3, 4, {1, 0.3, 0}, 0}, {0.2, 2.9, {0.2, 1, 0}, 1}};
  Sea sea(std::make_shared<AiryWaves>(CalmSea{}, waves));
  Start start;
  start.position.z() = -0.1;
  btRigidBody& body = sea.add({}, start, {true, {0.3}});
  Rail rail(sea, body, 0, 0.3);
  double sum = 0.3, come = 0, gone = 0;
  const unsigned steps = runsOf(100000);
  for (unsigned i = 0; i < steps; ++i) {
    sea.scene.step(1 / 60.0);
    const double inflow = sea.of(body).vessel->holds[0].inflow;
    sum += inflow;
    (inflow > 0 ? come : gone) += std::abs(inflow);
  }
  EXPECT_NEAR(sea.water(body), sum, 1e-12 * kCapacity);
  EXPECT_GT(come, 3e-4 * steps);
  EXPECT_GT(gone, 3e-4 * steps);
  const HoldWater hold = sea.scene.fluid.find(body)->holds().at(0);
  EXPECT_NEAR(hold.flooded, come, 1e-9);
  EXPECT_NEAR(hold.drained, gone, 1e-9);
}

/// What comes over the rim of an empty barge in waves along x, by Poleni's formula at each place
/// [m^3].
double overRim(const WaveComponent& wave, double freeboard, double time) {
  constexpr int kSteps = 2000, kPlaces = 400;
  const double k = 4 * kPi * kPi / (wave.period * wave.period * kGravity);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double phase = 2 * kPi / wave.period * (i + 0.5) / kSteps * time - wave.phase;
    const auto over = [&](double x) {
      return std::pow(std::max(0.0, wave.amplitude * std::cos(k * x - phase) - freeboard), 1.5);
    };
    for (int j = 0; j < kPlaces; ++j)
      sum += 2 * over(1.96 * ((j + 0.5) / kPlaces - 0.5)) * 1.96 / kPlaces;
    sum += 0.96 * (over(0.98) + over(-0.98));
  }
  return 0.6 * std::sqrt(2 * kGravity) * 2 / 3 * sum * time / kSteps;
}

// Waves half as long as a barge that is held slop over its rim, where it meets them.
TEST(Vessel, WavesShorterThanTheHullComeOverItsRim) {
  for (const double length : {1.0, 2.0}) {
    const WaveComponent wave{0.04, std::sqrt(2 * kPi * length / kGravity), {1, 0, 0}, 0.3};
    Sea sea(std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{wave}));
    Start start;
    start.position.z() = -0.23;
    btRigidBody& body = sea.add({}, start, {true, {0}});
    Rail rail(sea, body, 0, 0);
    const double time = 6 * wave.period;
    sea.scene.step(1 / 240.0, static_cast<int>(std::lround(time * 240)));
    const double exact = overRim(wave, 0.02, time);
    EXPECT_NEAR(sea.water(body), exact, 0.02 * exact) << length;
    EXPECT_TRUE(sea.of(body).vessel->has_waves);
  }
}

// Nothing is asked for where the sea is still, or the waves are long.
TEST(Vessel, RimIsThatOfThePlaneInLongWaves) {
  const WaveComponent swell{0.04, 12, {1, 0, 0}, 0};
  Sea sea(std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{swell}));
  btRigidBody& body = sea.add({}, {});
  sea.scene.step(1 / 60.0);
  EXPECT_FALSE(sea.of(body).vessel->has_waves);
}

TEST(Vessel, StateGoesOnBitForBit) {
  const auto start = [](Sea& sea) -> btRigidBody& {
    OpenBarge barge;
    barge.hole = 0.002;
    Start at;
    at.orientation = rotationFromVector(Vector3(0.1, 0.05, 0));
    return sea.add(barge, at, {true, {0.05}});
  };
  Sea sea;
  btRigidBody& body = start(sea);
  sea.scene.of(body).pump(0, -1e-4);
  sea.scene.step(1 / 60.0, 100);
  const WorldState state = sea.scene.fluid.save();
  const double before = sea.water(body);
  const auto run = [](Sea& world, btRigidBody& of) {
    world.scene.step(1 / 60.0, 200);
    return std::pair(of.getWorldTransform(), world.water(of));
  };
  const auto first = run(sea, body);
  EXPECT_GT(first.second, before + 0.001);
  sea.scene.fluid.restore(state);
  EXPECT_EQ(sea.water(body), before);
  EXPECT_TRUE(run(sea, body) == first);
  const std::shared_ptr<const FluidBody> shape = sea.scene.of(body).fluidBody();
  const WorldState read =
      decodeState(encodeState(state), "state", [&](const std::string&) { return shape; });
  Sea other;
  btRigidBody& same = start(other);
  other.scene.fluid.restore(read);
  EXPECT_TRUE(run(other, same) == first);
}

// A hole shot into the floor floods as one that the shape has; shut, it does not; open again, it
// does.
TEST(Vessel, HoleThatIsShotIntoAHullSinksIt) {
  Sea sea;
  btRigidBody& body = sea.add({}, {});
  const Immersed barge = sea.scene.of(body);
  sea.scene.step(1 / 60.0, 600);
  EXPECT_EQ(sea.water(body), 0);
  EXPECT_EQ(barge.addOpening(0, {0.3, 0, -0.23}, {0, 0, -2}, 0.01), 1);
  const double level = barge.holds().at(0).freeboard;
  EXPECT_NEAR(level, 0, 1e-6) << "its lowest opening is in the floor";
  sea.scene.step(1 / 60.0, 60);
  const double flooded = sea.water(body);
  EXPECT_NEAR(flooded, 0.6 * 0.01 * std::sqrt(2 * kGravity * 0.08), 4e-4) << "at 0.08 m of head";
  barge.setOpening(0, 1, false);
  sea.scene.step(1 / 60.0, 600);
  EXPECT_EQ(sea.water(body), flooded);
  EXPECT_NEAR(barge.holds().at(0).freeboard, 0.48 - flooded / (1.96 * 0.96), 2e-3);
  barge.setOpening(0, 1, true);
  const double exact = exactTimeToDip();
  EXPECT_NEAR(timeToDip(sea, body, 60), exact - 1, 0.01 * exact);
}

// It is said once, in this step and after a restored one; of another vessel once more. What stays
// afloat or begins as a wreck is not spoken of.
TEST(Vessel, SaysOnceThatItSinks) {
  Sea sea;
  OpenBarge barge;
  barge.hole = 0.05;
  btRigidBody& body = sea.add(barge, {});
  Start beside;
  beside.position.y() = 20;
  beside.mass = 500;
  sea.add(barge, beside);
  Start wreck;
  wreck.position = {20, 0, -3};
  sea.add(barge, wreck);
  Start light;
  light.position = {20, 20, 0};
  light.mass = 60;
  btRigidBody& afloat = sea.add(barge, light);
  const WorldState before = sea.scene.fluid.save();
  const std::string sentence =
      "bullet_ambient: a body with fluid body 'barge' sinks: its hold 'hold' of 0.9032 m^3 is full "
      "of water";
  sea.scene.step(1 / 60.0, 60 * 60);
  EXPECT_EQ(sea.scene.said, (std::vector<std::string>{sentence, sentence}));
  // Floor and walls displace 60 l where it is 0.189 m deep.
  EXPECT_NEAR(sea.water(afloat), 1.96 * 0.96 * 0.169, 5e-3);
  EXPECT_GT(middleOf(afloat), -0.5);
  EXPECT_TRUE(sea.of(body).vessel->has_sunk);
  sea.scene.fluid.restore(sea.scene.fluid.save());
  sea.scene.step(1 / 60.0, 60);
  EXPECT_EQ(sea.scene.said.size(), 2u);
  sea.scene.fluid.restore(before);
  EXPECT_FALSE(sea.of(body).vessel->has_sunk);
}

// A hatch over the rim: awash, a barge takes no water before it opens.
TEST(Vessel, HatchKeepsTheSeaOut) {
  Sea sea;
  Start start;
  start.mass = 900;
  btRigidBody& body = sea.add({}, start, {true, {0}});
  const Immersed barge = sea.scene.of(body);
  barge.setOpening(0, 0, false);
  for (int i = 0; i < 20; ++i) {
    body.applyCentralForce({0, 0, bt(-150 * kGravity)});
    sea.scene.step(1 / 60.0);
  }
  sea.scene.step(1 / 60.0, 600);
  EXPECT_EQ(sea.water(body), 0);
  EXPECT_GT(middleOf(body), -0.25);
  barge.setOpening(0, 0, true);
  barge.addOpening(0, {0, 0.48, -0.1}, {0, 1, 0}, 0.01);  // a scupper under water
  sea.scene.step(1 / 60.0, 600);
  EXPECT_DOUBLE_EQ(sea.water(body), kCapacity);
}

// What a shut door keeps apart comes level when it opens.
TEST(Vessel, DoorBetweenHoldsIsShutAndOpened) {
  OpenBarge barge;
  barge.holds = 2;
  barge.door = 0.01;
  Sea sea;
  btRigidBody& body = sea.add(barge, {}, {true, {0.05, 0}});
  const Immersed boat = sea.scene.of(body);
  boat.setOpening(0, 1, false);
  sea.scene.step(1 / 60.0, 120);
  EXPECT_EQ(sea.water(body), 0.05);
  boat.setOpening(0, 1, true);
  sea.scene.step(1 / 60.0, 1200);
  EXPECT_LT(sea.water(body), 0.04);
  EXPECT_NEAR(sea.water(body) + boat.holds().at(1).volume, 0.05, 1e-12);
}

// Gives another sea of the same bodies a state that went through its bytes.
void restore(Sea& sea, const WorldState& state, const std::shared_ptr<const FluidBody>& shape) {
  sea.scene.fluid.restore(
      decodeState(encodeState(state), "state", [&](const std::string&) { return shape; }));
}

TEST(Vessel, StateHasHolesAndShutDoors) {
  const auto start = [](Sea& sea) -> btRigidBody& {
    OpenBarge barge;
    barge.hole = 0.01;
    return sea.add(barge, {}, {});
  };
  Sea sea;
  btRigidBody& body = start(sea);
  sea.scene.of(body).setOpening(0, 1, false);
  sea.scene.of(body).addOpening(0, {0.5, 0.2, -0.23}, {0, 0, -1}, 0.002);
  sea.scene.step(1 / 60.0, 100);
  const WorldState state = sea.scene.fluid.save();
  const auto run = [](Sea& world, btRigidBody& of) {
    world.scene.step(1 / 60.0, 200);
    return std::pair(of.getWorldTransform(), world.water(of));
  };
  const auto first = run(sea, body);
  const std::shared_ptr<const FluidBody> shape = sea.scene.of(body).fluidBody();
  Sea other;
  btRigidBody& same = start(other);
  restore(other, state, shape);
  EXPECT_TRUE(run(other, same) == first);
  EXPECT_EQ(other.of(same).vessel->changes.holes.size(), 1u);
  other.scene.of(same).setOpening(0, 2, false);
  const double water = other.water(same);
  other.scene.step(1 / 60.0, 60);
  EXPECT_EQ(other.water(same), water);
}

// A capsized barge goes on with the bits of its air.
TEST(Vessel, StateHasTheAirThatWaterShutsOff) {
  const auto start = [](Sea& sea) -> btRigidBody& {
    Start at = capsized();
    at.mass = 1000;
    at.position.z() = 0.2;
    return sea.add({}, at, {});
  };
  Sea sea;
  btRigidBody& body = start(sea);
  sea.scene.step(1 / 60.0, 60);
  ASSERT_TRUE(sea.of(body).vessel->holds[0].is_sealed);
  const WorldState state = sea.scene.fluid.save();
  const auto run = [](Sea& world, btRigidBody& of) {
    world.scene.step(1 / 60.0, 200);
    return std::tuple(of.getWorldTransform(), world.water(of), world.of(of).vessel->holds[0].air);
  };
  const auto first = run(sea, body);
  const std::shared_ptr<const FluidBody> shape = sea.scene.of(body).fluidBody();
  Sea other;
  btRigidBody& same = start(other);
  restore(other, state, shape);
  EXPECT_TRUE(run(other, same) == first);
}

// A vessel afloat with water becomes another vessel, a body without holds, and a vessel again.
TEST(Vessel, FluidBodyIsReplacedAfloat) {
  Sea sea;
  btRigidBody& body = sea.add({}, {}, {true, {0.1}});
  const Immersed boat = sea.scene.of(body);
  sea.scene.step(1 / 60.0, 30);
  OpenBarge two;
  two.holds = 2;
  boat.setFluidBody(std::make_shared<FluidBody>(openBarge(two)));
  EXPECT_EQ(boat.holds().size(), 2u);
  EXPECT_EQ(boat.holds().at(0).volume, 0);
  EXPECT_GT(boat.kineticEnergy(), 0);
  sea.scene.step(1 / 60.0, 30);
  FluidBody closed = openBarge({});
  closed.holds.clear();
  boat.setFluidBody(std::make_shared<FluidBody>(closed));
  EXPECT_TRUE(boat.holds().empty());
  EXPECT_GT(boat.wet().volume, 0);
  sea.scene.step(1 / 60.0, 30);
  boat.setFluidBody(std::make_shared<FluidBody>(openBarge({})));
  boat.setWater(0, 0.05);
  boat.addOpening(0, {0, 0, -0.23}, {0, 0, -1}, 1e-3);
  sea.scene.step(1 / 60.0, 30);
  EXPECT_GT(sea.water(body), 0.05);
  boat.setFluidBody(std::make_shared<FluidBody>(openBarge(two)));
  EXPECT_TRUE(sea.of(body).vessel->changes.holes.empty());
  sea.scene.step(1 / 60.0, 600);
  EXPECT_NEAR(middleOf(body), 0.25 - 0.1, 2e-3);
}

TEST(Vessel, DryBargeSleepsAndALeakingOneDoesNot) {
  for (const double hole : {0.0, 1e-4}) {
    Sea sea;
    OpenBarge barge;
    barge.hole = hole;
    btRigidBody& body = sea.add(barge, {});
    body.forceActivationState(ACTIVE_TAG);
    sea.scene.step(1 / 60.0, 60 * 60);
    EXPECT_EQ(body.isActive(), hole > 0);
    if (hole > 0) continue;
    sea.scene.of(body).setWater(0, 0.1);
    EXPECT_TRUE(body.isActive());
  }
}

TEST(Vessel, WreckStartsFloodedAndASealedOneRises) {
  for (const bool are_open : {true, false}) {
    Sea sea;
    Start start;
    start.position.z() = -30;
    btRigidBody& body = sea.add({}, start, {are_open, {}});
    EXPECT_EQ(sea.scene.of(body).holds().at(0).volume, are_open ? kCapacity : 0);
    sea.scene.step(1 / 60.0, 120);
    EXPECT_EQ(middleOf(body) < -30, are_open);
    EXPECT_EQ(sea.water(body), are_open ? kCapacity : 0);
  }
}

TEST(Vessel, WaterIsSetPumpedAndRead) {
  Sea sea;
  btRigidBody& body = sea.add({}, {});
  const Immersed barge = sea.scene.of(body);
  sea.scene.step(1 / 60.0, 600);
  barge.setWater(0, 0.2);
  const HoldWater set = barge.holds().at(0);
  EXPECT_EQ(set.volume, 0.2);
  EXPECT_DOUBLE_EQ(set.capacity, kCapacity);
  EXPECT_NEAR(set.area, 1.96 * 0.96, byPrecision(1e-9, 1e-4));
  EXPECT_NEAR(set.freeboard, 0.48 - 0.2 / (1.96 * 0.96), byPrecision(1e-6, 1e-3));
  EXPECT_NEAR(set.centre.z(), middleOf(body) - 0.23 + 0.1 / (1.96 * 0.96), 1e-3);
  EXPECT_NEAR(set.level.z(), middleOf(body) + 0.25 - set.freeboard, 1e-3);
  sea.scene.step(1 / 60.0, 1800);
  EXPECT_NEAR(middleOf(body), 0.25 - 0.2, 2e-3) << "draught 0.2 m";
  barge.pump(0, -0.01);
  sea.scene.step(1 / 60.0, 600);
  EXPECT_NEAR(sea.water(body), 0.1, byPrecision(1e-12, 1e-8)) << "of the step";
  EXPECT_NEAR(barge.holds()[0].inflow, -0.01 / 60, byPrecision(1e-15, 1e-9));
  sea.scene.step(1 / 60.0, 1800);
  EXPECT_EQ(sea.water(body), 0);
  EXPECT_NEAR(middleOf(body), 0.25 - 0.1, 2e-3);
}

TEST(Vessel, WhatDoesNotFitIsRefusedInOneLine) {
  Sea sea;
  const auto refusal = [](const auto& action) { return refusalOf<std::invalid_argument>(action); };
  EXPECT_EQ(refusal([&] {
              sea.add({}, {}, {true, {1}});
            }),
            "add: body with fluid body 'barge' has 1.000000 m^3 of water in hold 0, which must be "
            "zero to 0.903168");
  EXPECT_EQ(refusal([&] {
              sea.add({}, {}, {true, {0.1, 0.1}});
            }),
            "add: body with fluid body 'barge' has water for 2 holds, but its fluid body has 1");
  const Immersed barge = sea.scene.of(sea.add({}, {}));
  EXPECT_EQ(refusal([&] { barge.setWater(1, 0); }),
            "setWater: body with fluid body 'barge' has 1 holds, and none has the number 1");
  EXPECT_EQ(refusal([&] { barge.setWater(0, -1); }),
            "setWater: body with fluid body 'barge' has -1.000000 m^3 of water in hold 0, which "
            "must be zero to 0.903168");
  EXPECT_EQ(refusal([&] { barge.setOpening(0, 1, false); }),
            "setOpening: hold 0 of body with fluid body 'barge' has no opening with the number 1");
  EXPECT_EQ(refusal([&] {
              barge.addOpening(0, {0, 0, 0}, {0, 0, -1}, 0);
            }),
            "addOpening: body with fluid body 'barge' would have a hole of 0.000000 m^2, which "
            "must be positive and finite");
  EXPECT_EQ(refusal([&] {
              barge.addOpening(0, {0, 0, 0}, {0, 0, 0}, 1);
            }),
            "addOpening: body with fluid body 'barge' would have a hole without a direction out "
            "of the hold");
  EXPECT_EQ(refusal([&] {
              barge.addOpening(0, {0, 3, 0}, {0, 0, 1}, 1);
            }),
            "addOpening: body with fluid body 'barge' would have a hole at (0.000000, 3.000000, "
            "0.000000) m in the frame of its fluid body, which is not at the body");
  EXPECT_EQ(refusal([&] { barge.pump(0, INFINITY); }),
            "pump: the rate [m^3/s] is inf, must be finite");
}

}  // namespace
}  // namespace ambient::test
