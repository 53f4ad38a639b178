#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <tuple>
#include <vector>

#include "tests/bullet_ambient/bullet/water/vessel_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

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

}  // namespace
}  // namespace ambient::test
