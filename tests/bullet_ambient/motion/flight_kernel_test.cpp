#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "demos/integrators/integrators.h"
#include "tests/bullet_ambient/motion/kernel_fixture.h"
#include "tests/bullet_ambient/motion/loaded_bodies.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::flowWithoutLoads;
using test::FreeBody;

FreeBody movingBody(unsigned seed) {
  Arbitrary arbitrary(seed);
  FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
  body.state.twist = arbitrary.twist(10, 3);
  return body;
}

// Different bodies in random motion under random loads, for kicks and flows up to `time`.
FlightLanes arbitraryLanes(unsigned seed, double time) {
  FlightLanes lanes{};
  lanes.has_loads = true;
  for (int i = 0; i < kFlightLanes; ++i) {
    Arbitrary arbitrary(kFlightLanes * seed + static_cast<unsigned>(i));
    FreeBody body = movingBody(kFlightLanes * seed + static_cast<unsigned>(i));
    body.state.orientation = arbitrary.rotation();
    body.state.position = arbitrary.vector();
    body.setGravity({0, 0, -9.81});
    setModel(lanes, i, body.model());
    setSurroundings(lanes, i, {body.model(), body.surroundings, body.settings, time});
    setState(lanes, i, body.model(), body.state);
    lanes.active[i] = arbitrary.between(0, 1) < 0.8 ? 1 : 0;
    lanes.precision[i] = std::pow(10, arbitrary.between(-16, -6));
    lanes.drift_time[i] = arbitrary.between(0, time);
    lanes.kick_time[i] = arbitrary.between(0, time);
    const double strength = std::pow(10, arbitrary.between(-3, 3));
    for (int k = 0; k < 6; ++k) {
      lanes.load_W[k][i] = strength * arbitrary.between(-1, 1);
      lanes.load_B[k][i] = strength * arbitrary.between(-1, 1);
    }
  }
  return lanes;
}

void substep(const FlightKernel& kernel, FlightLanes& lanes) {
  kernel.measure(lanes);
  kernel.drift(lanes);
  kernel.applyGravity(lanes);
  kernel.sample(lanes);
  kernel.kick(lanes);
  kernel.drift(lanes);
  kernel.bound(lanes);
}

// Pose, motion and last load of a body.
std::vector<double> motion(const FlightLanes& lanes, int body) {
  std::vector<double> values;
  const auto add = [&](const FlightLane* from, int count) {
    for (int i = 0; i < count; ++i) values.push_back(from[i][body]);
  };
  add(lanes.orientation, 4);
  add(lanes.displacement_W, 3);
  add(lanes.twist_B, 6);
  add(lanes.momentum_B, 6);
  add(lanes.load_W, 6);
  return values;
}

// Results of motion(), and all else that a substep changes of an active body.
std::vector<double> lane(const FlightLanes& lanes, int body) {
  std::vector<double> values = motion(lanes, body);
  values.insert(values.end(),
                {lanes.error[body], lanes.is_coarse[body], lanes.energy_removed[body]});
  return values;
}

bool haveSameBits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

class FlightKernels : public test::FlightKernelTest {};

TEST_P(FlightKernels, HaveTheBitsOfTheBaseline) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    for (const double time : {1e-3, 1.0 / 60, 3.0}) {
      FlightLanes baseline = arbitraryLanes(seed, time);
      FlightLanes other = baseline;
      substep(kFlightKernelBaseline, baseline);
      substep(*kernel_, other);
      for (int i = 0; i < kFlightLanes; ++i) {
        if (!(baseline.active[i] > 0)) continue;
        EXPECT_TRUE(haveSameBits(lane(baseline, i), lane(other, i))) << seed << " over " << time;
        EXPECT_TRUE(std::isfinite(other.twist_B[0][i])) << seed << " over " << time;
      }
    }
  }
}

TEST_P(FlightKernels, MoveABodyByTheSameBitsWhoeverFliesBesideIt) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    FlightLanes together = arbitraryLanes(seed, 0.1);
    const FlightLanes start = together;
    substep(*kernel_, together);
    for (int i = 0; i < kFlightLanes; ++i) {
      FlightLanes alone = start;
      for (int k = 0; k < kFlightLanes; ++k)
        alone.active[k] = k == i && start.active[k] > 0 ? 1 : 0;
      substep(*kernel_, alone);
      EXPECT_TRUE(haveSameBits(lane(together, i), lane(alone, i)) || !(start.active[i] > 0))
          << seed;
    }
  }
}

TEST_P(FlightKernels, LeaveBodiesAloneThatAreNotActive) {
  FlightLanes lanes = arbitraryLanes(1, 0.1);
  for (double& active : lanes.active) active = 0;
  lanes.active[0] = 1;
  const FlightLanes start = lanes;
  substep(*kernel_, lanes);
  EXPECT_NE(lanes.twist_B[0][0], start.twist_B[0][0]);
  for (int i = 1; i < kFlightLanes; ++i) {
    EXPECT_TRUE(haveSameBits(motion(start, i), motion(lanes, i))) << i;
  }
}

TEST_P(FlightKernels, GrowAResistanceByTheBitsOfOneAlone) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    FlightLanes lanes = arbitraryLanes(seed, 0.1);
    lanes.has_resistance = true;
    Matrix6 grown[kFlightLanes];
    for (int i = 0; i < kFlightLanes; ++i) {
      Arbitrary arbitrary(kFlightLanes * seed + static_cast<unsigned>(i));
      const Resistance resistance{arbitrary.positiveDefinite(), arbitrary.vector()};
      const ambient::Growth growth{arbitrary.between(0, 3), arbitrary.between(0, 3)};
      setResistance(lanes, i, &resistance);
      setGrowth(lanes, i, growth);
      lanes.active[i] = 1;
      grown[i] = resistance.grown(growth);
    }
    kernel_->sample(lanes);
    for (int i = 0; i < kFlightLanes; ++i)
      for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column)
          EXPECT_EQ(lanes.resistance[symmetricEntry(row, column)][i], grown[i](row, column))
              << seed << ", " << row << ", " << column;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FlightKernels, test::kAllInstructionSets);

// Body `i` of many that differ in speed, loads, integrator and current.
FreeBody oneOfMany(unsigned i) {
  FlightSettings settings;
  if (i % 7 == 5) settings.own_flight = flyRungeKutta;
  FreeBody body = i % 3 == 0   ? test::glidingDisc(settings)
                  : i % 3 == 1 ? test::tumblingEllipsoid(settings)
                               : movingBody(i);
  body.settings = settings;
  Arbitrary arbitrary(i);
  const Twist more = arbitrary.twist(i % 5 == 0 ? 300 : 3, i % 4 == 0 ? 20 : 1);
  body.state.twist = {body.state.twist.angular + more.angular,
                      body.state.twist.linear + more.linear};
  body.state.orientation = arbitrary.rotation();
  if (i % 2 == 0) body.surroundings.ambient_velocity = {3, 0, 1};
  return body;
}

TEST(FlyTogether, HasTheBitsOfEachFlightAlone) {
  constexpr unsigned kCount = 27;
  std::vector<FreeBody> bodies;
  for (unsigned i = 0; i < kCount; ++i) bodies.push_back(oneOfMany(i));
  std::vector<Flight> flights;
  std::vector<Flight*> all;
  flights.reserve(kCount);
  for (const FreeBody& body : bodies) {
    flights.emplace_back(FlightTask{body.model(), body.surroundings, body.settings, 1.0 / 60},
                         body.state, FlightMemory{});
    all.push_back(&flights.back());
  }
  int most_substeps = 0;
  for (int step = 0; step < 3; ++step) {
    const std::vector<Flight> starts = flights;
    flyTogether(all.data(), static_cast<int>(kCount));
    for (unsigned i = 0; i < kCount; ++i) {
      const FlightResult& start = starts[i].body;
      const FlightResult alone = fly(flights[i].task, start.state, start.memory);
      const FlightResult& together = flights[i].body;
      EXPECT_EQ(alone.state.orientation.coeffs(), together.state.orientation.coeffs()) << i;
      EXPECT_EQ(alone.state.position, together.state.position) << i;
      EXPECT_EQ(alone.state.twist.vector(), together.state.twist.vector()) << i;
      EXPECT_EQ(alone.memory.load_W.vector(), together.memory.load_W.vector()) << i;
      EXPECT_EQ(alone.memory.substep, together.memory.substep) << i;
      EXPECT_EQ(alone.count.substeps, together.count.substeps) << i;
      EXPECT_EQ(alone.count.load_evaluations, together.count.load_evaluations) << i;
      most_substeps = std::max(most_substeps, together.count.substeps);
    }
  }
  EXPECT_GT(most_substeps, 4);  // bodies differ
}

TEST(FlowWithoutLoads, IsAsPreciseAsAskedAndNeverGainsEnergy) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    for (const double precision : {1e-6, 1e-9, 1e-12}) {
      FreeBody body = movingBody(seed);
      const double before = body.kineticEnergy();
      const RigidState exact = flowWithoutLoads(body, 0.02).state;
      body.state = flowWithoutLoads(body, 0.02, precision).state;
      const Vector6 error = body.state.twist.vector() - exact.twist.vector();
      EXPECT_LT(std::sqrt(inertiaNormSquared(body.model(), error) / (2 * before)), precision)
          << seed;
      EXPECT_LT(angleBetween(body.state.orientation, exact.orientation), precision) << seed;
      // Rounding of the scaling: of each component, and of the factor.
      EXPECT_LE(body.kineticEnergy(), before * (1 + 1e-15)) << seed;
    }
  }
}

using test::FreeBody;

TEST(Flight, AllocatesNothing) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  FreeBody body({test::meshedEllipsoid(semi_axes, 1), {10, Matrix3::Identity()}, water(), {2.0}});
  body.setGravity({0, 0, -9.81});
  for (const double spin : {1.0, 1e3, 1e5}) {
    for (const OwnFlight integrator : std::initializer_list<OwnFlight>{nullptr, flyRungeKutta}) {
      body.state.twist = {{spin, 2, 3}, {1, 2, 3}};
      body.settings = {1e-3, 16, integrator};
      const std::size_t before = test::allocationCount();
      body.advance(1.0 / 60, 3);
      EXPECT_EQ(test::allocationCount(), before);
    }
  }
}

TEST(RowVelocity, AllocatesNothing) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  FreeBody body({test::meshedEllipsoid(semi_axes, 1), {10, Matrix3::Identity()}, water(), {2.0}});
  for (const double spin : {1.0, 1e3}) {
    body.state.twist = {{spin, 2, 3}, {1, 2, 3}};
    const std::size_t before = test::allocationCount();
    computeRowVelocity({body.model(), body.surroundings, body.settings, 1.0 / 60}, body.state);
    EXPECT_EQ(test::allocationCount(), before);
  }
}

}  // namespace
}  // namespace ambient
