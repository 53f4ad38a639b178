#include <gtest/gtest.h>

#include "demos/integrators/integrators.h"
#include "tests/bullet_ambient/motion/loaded_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::exactEnd;
using test::FreeBody;
using test::glidingDisc;
using test::kDuration;
using test::MakeBody;
using test::tumblingEllipsoid;

constexpr int kFlightSteps = 24;  // at 60 Hz

FlightSettings accurate(double tolerance, int max_substeps = 0) {
  return {tolerance, max_substeps, flyDormandPrince};
}

FreeBody fliesWith(MakeBody make, const FlightSettings& settings) {
  FreeBody body = make(settings);
  body.advance(kDuration / kFlightSteps, kFlightSteps);
  return body;
}

double distance(const RigidState& a, const RigidState& b) {
  return (a.position - b.position).norm();
}

TEST(DormandPrince, ErrorFollowsTheToleranceWhereTheLoadsAreSmooth) {
  const RigidState exact = exactEnd(glidingDisc, 8000);
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const FreeBody disc = fliesWith(glidingDisc, accurate(tolerance));
    // 24 steps; unstable glide amplifies errors fivefold. The disc's length is 0.24 m.
    constexpr double kGrowth = 24 * 5;
    EXPECT_LT(distance(disc.state, exact), kGrowth * tolerance * 0.24) << tolerance;
    EXPECT_LT(angleBetween(disc.state.orientation, exact.orientation), kGrowth * tolerance);
  }
}

TEST(DormandPrince, WorkGrowsWithTheFifthRootOfTheTolerance) {
  // One long step: steps of the world would cut substeps and hide the order.
  const auto work = [](double tolerance) {
    FreeBody disc = glidingDisc(accurate(tolerance));
    disc.advance(kDuration);
    return static_cast<double>(disc.count.load_evaluations);
  };
  EXPECT_NEAR(std::log10(work(1e-11) / work(1e-6)), 1, 0.2);
}

TEST(DormandPrince, KeepsMomentumAndEnergyWithoutLoads) {
  Arbitrary arbitrary(3);
  for (int i = 0; i < 20; ++i) {
    FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
    body.state.twist = arbitrary.twist(4, 2);
    body.settings = accurate(1e-11);
    const double energy = body.kineticEnergy();
    const Momentum before = body.worldMomentum();
    body.advance(1.0 / 30, 30);
    EXPECT_NEAR(body.kineticEnergy(), energy, 1e-8 * energy);
    EXPECT_LT((body.worldMomentum().vector() - before.vector()).norm(),
              1e-12 * before.vector().norm() * body.state.position.norm() + 1e-12);
  }
}

TEST(DormandPrince, AgreesWithTheLeapfrogWhoseFlowIsExactWithoutLoads) {
  Arbitrary arbitrary(4);
  for (int i = 0; i < 20; ++i) {
    FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
    body.state.twist = arbitrary.twist(4, 2);
    FreeBody other = body;
    body.settings = accurate(1e-11);
    body.advance(1.0 / 30, 30);
    other.advance(1.0 / 30, 30);
    EXPECT_LT(distance(body.state, other.state), 1e-7 * (1 + body.state.position.norm()));
  }
}

/// A wooden cube in water: rises and chatters about the attitude with a side square to the flow,
/// where this side's pressure jumps.
FreeBody risingCube(const FlightSettings& settings) {
  constexpr double kSide = 0.2, kDensity = 998;
  const double volume = kSide * kSide * kSide, displaced = kDensity * volume;
  FluidBody shape;
  shape.name = "cube";
  shape.added_mass.diagonal() << 3e-6, 3e-6, 3e-6, 5.1e-3, 5.1e-3, 5.1e-3;
  shape.volume = volume;
  shape.area = 6 * kSide * kSide;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      for (int quarter = 0; quarter < 4; ++quarter) {
        Vector3 normal = Vector3::Zero(), centroid;
        normal[axis] = side;
        centroid[axis] = side * kSide / 2;
        centroid[(axis + 1) % 3] = (quarter % 2 - 0.5) * kSide / 2;
        centroid[(axis + 2) % 3] = (quarter / 2 - 0.5) * kSide / 2;
        shape.faces.add(normal, centroid, kSide * kSide / 4);
      }
    }
  }
  const double mass = displaced / 2;
  const Matrix3 inertia = mass * kSide * kSide / 6 * Matrix3::Identity();
  FreeBody cube({shape, {mass, inertia}, {kDensity, 1e-3, Vector3::Zero(), Vector3::Zero()}});
  cube.settings = settings;
  cube.setGravity({0, 0, -9.81});
  cube.state.orientation = Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()));
  return cube;
}

TEST(DormandPrince, NoBodyRisesFasterThanWithoutLoads) {
  for (const double tolerance : {1e-3, 1e-4}) {
    FreeBody cube = risingCube(accurate(tolerance));
    // Buoyancy over the mass of body and fluid; the cube's inertia is isotropic.
    const double mass = cube.model().inertia(5, 5);
    const double acceleration = 9.81 * (cube.model().displaced_mass - cube.model().mass) / mass;
    for (int i = 1; i <= 90; ++i) {
      cube.advance(1.0 / 60);
      const double speed = std::sqrt(2 * cube.kineticEnergy() / mass);
      ASSERT_LE(speed, acceleration * i / 60 * (1 + 1e-9)) << tolerance << ", step " << i;
    }
  }
}

TEST(DormandPrince, IsMoreAccurateThanTheLeapfrogWhereFacesSwitch) {
  const RigidState exact = exactEnd(tumblingEllipsoid, 8000);
  const FreeBody plate = fliesWith(tumblingEllipsoid, accurate(1e-6));
  const FreeBody leap = fliesWith(tumblingEllipsoid, {});
  // Measured: 1.9e-5 and 1.5e-4 m.
  EXPECT_LT(distance(plate.state, exact), distance(leap.state, exact) / 5);
}

TEST(DormandPrince, HandsOverToTheLeapfrogWhenItsAttemptsAreSpent) {
  // A light plate at 300 m/s: explicit steps of this length are unstable.
  FreeBody plate = tumblingEllipsoid(accurate(1e-8, 5));
  plate.state.twist = {{100, 50, 20}, {300, 0, 300}};
  plate.setGravity(Vector3::Zero());
  double energy = plate.kineticEnergy();
  for (int i = 0; i < 60; ++i) {
    const FlightResult result =
        fly({plate.model(), plate.surroundings, plate.settings, 1.0 / 60}, plate.state, {});
    if (i == 0) {
      EXPECT_TRUE(result.count.coarse);
    }
    plate.state = result.state;
    ASSERT_TRUE(plate.state.isFinite());
    EXPECT_LE(plate.kineticEnergy(), energy * (1 + 1e-6));
    energy = plate.kineticEnergy();
  }
}

TEST(DormandPrince, ANumberThatIsNotFiniteEndsTheStep) {
  FreeBody plate = tumblingEllipsoid(accurate(1e-6));
  plate.state.twist.linear.x() = std::numeric_limits<double>::quiet_NaN();
  plate.advance(1.0 / 60);
  EXPECT_FALSE(plate.state.isFinite());
}

}  // namespace
}  // namespace ambient
