#include <gtest/gtest.h>

#include <algorithm>

#include "demos/integrators/integrators.h"
#include "tests/bullet_ambient/motion/loaded_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

using test::exactEnd;
using test::FreeBody;
using test::glidingDisc;
using test::kDuration;
using test::MakeBody;
using test::tumblingEllipsoid;

double positionError(MakeBody make, const FlightSettings& settings, int steps,
                     const RigidState& exact) {
  FreeBody body = make(settings);
  body.advance(kDuration / steps, steps);
  return (body.state.position - exact.position).norm();
}

TEST(Leapfrog, IsOfSecondOrderWhereTheLoadsAreSmooth) {
  const RigidState exact = exactEnd(glidingDisc, 8000);
  const FlightSettings settings{1e-3, 1};
  const double coarse = positionError(glidingDisc, settings, 40, exact);
  const double fine = positionError(glidingDisc, settings, 160, exact);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.15);
}

TEST(RungeKutta, IsOfFourthOrderWhereTheLoadsAreSmooth) {
  const RigidState exact = exactEnd(glidingDisc, 8000);
  const FlightSettings settings{1e-3, 1, flyRungeKutta};
  const double coarse = positionError(glidingDisc, settings, 320, exact);
  const double fine = positionError(glidingDisc, settings, 1280, exact);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 4, 0.3);
}

TEST(SymplecticEuler, IsOfFirstOrder) {
  const RigidState exact = exactEnd(glidingDisc, 8000);
  const FlightSettings settings{1e-3, 1, flySymplecticEuler};
  const double coarse = positionError(glidingDisc, settings, 5120, exact);
  const double fine = positionError(glidingDisc, settings, 20480, exact);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 1, 0.1);
}

TEST(SymplecticEuler, TakesAsManySubstepsAsItIsTold) {
  FreeBody many = glidingDisc({1e-3, 4, flySymplecticEuler});
  FreeBody few = glidingDisc({1e-3, 0, flySymplecticEuler});
  many.advance(kDuration / 100, 100);
  few.advance(kDuration / 400, 400);
  EXPECT_EQ(many.count.load_evaluations, 400);
  EXPECT_LT((many.state.position - few.state.position).norm(), 1e-12);
}

TEST(Integrators, ConvergeToTheSameMotionWhereFacesSwitch) {
  // Switching faces leave order 1 with a small constant. Measured 4e-4 (leapfrog) and 1e-4 m
  // (Runge-Kutta) at 60 Hz, 2e-6 and 3e-6 m at 960 Hz.
  const RigidState exact = exactEnd(tumblingEllipsoid, 8000);
  for (const OwnFlight integrator : std::initializer_list<OwnFlight>{nullptr, flyRungeKutta}) {
    const FlightSettings settings{1e-3, 1, integrator};
    const double coarse = positionError(tumblingEllipsoid, settings, 24, exact);
    const double fine = positionError(tumblingEllipsoid, settings, 384, exact);
    EXPECT_LT(fine, 2e-5);
    EXPECT_LT(fine, coarse / 8);
  }
}

TEST(Leapfrog, SubstepsAreChosenByTheTolerance) {
  const RigidState exact = exactEnd(tumblingEllipsoid, 8000);
  constexpr int kSteps = 24;  // at 60 Hz
  FreeBody loose = tumblingEllipsoid({1e-2, 0});
  FreeBody tight = tumblingEllipsoid({1e-4, 64});
  loose.advance(kDuration / kSteps, kSteps);
  tight.advance(kDuration / kSteps, kSteps);
  EXPECT_GT(tight.count.substeps, 3 * loose.count.substeps);
  EXPECT_LT((tight.state.position - exact.position).norm(),
            (loose.state.position - exact.position).norm());
  // One evaluation per substep, except for the first one and repeated steps.
  EXPECT_LE(loose.count.load_evaluations, loose.count.substeps + 3);
}

TEST(Leapfrog, ReportsAStepThatStaysAboveTheTolerance) {
  FreeBody plate = tumblingEllipsoid({});
  const FlightSettings hopeless{1e-12, 2};
  const FlightResult result =
      fly({plate.model(), plate.surroundings, hopeless, 1.0 / 60}, plate.state, {});
  EXPECT_TRUE(result.count.coarse);
  const FlightSettings easy{10, 2};
  EXPECT_FALSE(
      fly({plate.model(), plate.surroundings, easy, 1.0 / 60}, plate.state, {}).count.coarse);
}

// A switching face makes the error first order in the step. Two retries, which assume order 2, miss
// the tolerance far below max_substeps.
TEST(Leapfrog, ReportsAStepThatRetriesLeaveAboveTheTolerance) {
  FreeBody plate = tumblingEllipsoid({});
  const FlightSettings strict{1e-6, 1000000};
  const FlightResult result =
      fly({plate.model(), plate.surroundings, strict, 1.0 / 60}, plate.state, {});
  EXPECT_LT(result.count.substeps, strict.max_substeps / 2);
  EXPECT_TRUE(result.count.coarse);
  EXPECT_GT(result.count.error, 2 * strict.tolerance);
}

TEST(RungeKutta, TurnsByLessThanSixDegreesPerSubstep) {
  FreeBody plate = tumblingEllipsoid({1e-3, 0, flyRungeKutta});
  plate.state.twist.angular = {0, 0, 100};
  plate.advance(1.0 / 60);
  // 100 / 60 rad in parts of 5.7 degrees.
  EXPECT_EQ(plate.count.substeps, 17);
  EXPECT_EQ(plate.count.load_evaluations, 4 * 17);
}

using test::Arbitrary;

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
