#include "tests/support/convergence.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_ambient/motion/rows/row_velocity.h"
#include "demos/integrators/integrators.h"
#include "tests/bullet_ambient/motion/loaded_bodies.h"
#include "tests/reference/full_inertia_accelerations.h"
#include "tests/reference/kirchhoff_motion.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"
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

TEST(Integrators, HaveTheirOrdersWhereTheLoadsAreSmooth) {
  struct Row {
    OwnFlight integrator;
    int steps;
    double order, tolerance;
  };
  const RigidState exact = exactEnd(glidingDisc, 8000);
  for (const auto& [integrator, steps, order, tolerance] :
       {Row{nullptr, 40, 2, 0.15}, Row{flyRungeKutta, 320, 4, 0.3},
        Row{flySymplecticEuler, 5120, 1, 0.1}}) {
    const FlightSettings settings{1e-3, 1, integrator};
    const double coarse = positionError(glidingDisc, settings, steps, exact);
    const double fine = positionError(glidingDisc, settings, 4 * steps, exact);
    EXPECT_NEAR(std::log2(coarse / fine) / 2, order, tolerance) << steps;
  }
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

using test::Flow;
using test::flowWithoutLoads;

constexpr int kBodies = 12;
constexpr double kSpinDuration = 2;  // [s]

FreeBody bodyWithCoupledInertia(unsigned seed) {
  Arbitrary arbitrary(seed);
  return FreeBody({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
}

void setInMotion(FreeBody& body, unsigned seed, double spin) {
  Arbitrary arbitrary(seed + 1000);
  body.state.orientation = Quaternion(arbitrary.rotation());
  body.state.position = arbitrary.vector();
  body.state.twist = {spin * arbitrary.vector().normalized(),
                      spin * 0.3 * arbitrary.vector().normalized()};
}

// Largest relative changes during a flight of quantities conserved without loads.
struct Drift {
  double energy = 0, body_momentum = 0, helicity = 0, world_momentum = 0, angular_momentum = 0;
};

double relative(double value, double start) { return std::abs(value - start) / std::abs(start); }

Drift measureDrift(FreeBody& body, double step) {
  const auto bodyMomentum = [&] {
    return Momentum::fromVector(body.model().inertia * body.state.twist.vector());
  };
  const double energy = body.kineticEnergy();
  const Momentum own = bodyMomentum();
  const Momentum world = body.worldMomentum();
  Drift drift;
  for (double t = 0; t < kSpinDuration; t += step) {
    body.advance(step);
    const Momentum p = bodyMomentum();
    const Momentum P = body.worldMomentum();
    const auto update = [](double& largest, double value) { largest = std::max(largest, value); };
    update(drift.energy, relative(body.kineticEnergy(), energy));
    update(drift.body_momentum, relative(p.linear.squaredNorm(), own.linear.squaredNorm()));
    update(drift.helicity, std::abs(p.linear.dot(p.angular) - own.linear.dot(own.angular)) /
                               (own.linear.norm() * own.angular.norm()));
    update(drift.world_momentum, (P.linear - world.linear).norm() / world.linear.norm());
    update(drift.angular_momentum, (P.angular - world.angular).norm() / world.angular.norm());
  }
  return drift;
}

// Tolerance: rounding of some thousand steps; measured 6e-13 at most.
constexpr double kRounding = 2e-12;

TEST(Leapfrog, KeepsEnergyMomentaAndHelicityWithoutLoads) {
  for (const double step : {1.0 / 60, 1.0 / 120, 1.0 / 240}) {
    for (unsigned seed = 0; seed < kBodies; ++seed) {
      FreeBody body = bodyWithCoupledInertia(seed);
      setInMotion(body, seed, 20);
      const Drift drift = measureDrift(body, step);
      EXPECT_LT(drift.energy, kRounding) << seed << " at " << step;
      EXPECT_LT(drift.body_momentum, kRounding) << seed << " at " << step;
      EXPECT_LT(drift.helicity, kRounding) << seed << " at " << step;
      EXPECT_LT(drift.world_momentum, kRounding) << seed << " at " << step;
      EXPECT_LT(drift.angular_momentum, kRounding) << seed << " at " << step;
    }
  }
}

// Rotation error [rad] after kSpinDuration against an integrator of order 16 in other unknowns;
// median body. Single bodies are chaotic and double initial rounding errors many times.
double medianRotationError(double spin, double step, OwnFlight integrator) {
  std::vector<double> errors;
  for (unsigned seed = 0; seed < kBodies; ++seed) {
    FreeBody body = bodyWithCoupledInertia(seed);
    body.settings.own_flight = integrator;
    setInMotion(body, seed, spin);
    reference::KirchhoffState s;
    s << body.state.orientation.coeffs(), body.state.position,
        body.model().inertia * body.state.twist.vector();
    const Eigen::Matrix<double, 6, 6> inertia = body.model().inertia;
    s = reference::integrate({test::inverse(inertia)}, s, kSpinDuration,
                             static_cast<int>(spin * 40));
    body.advance(step, static_cast<int>(std::lround(kSpinDuration / step)));
    errors.push_back(angleBetween(body.state.orientation, reference::orientationOf(s)));
  }
  std::sort(errors.begin(), errors.end());
  return errors[kBodies / 2];
}

TEST(Leapfrog, FollowsAnIndependentIntegrator) {
  // Motion amplifies rounding, equally at every step length.
  for (const double step : {1.0 / 60, 1.0 / 240}) {
    EXPECT_LT(medianRotationError(6, step, nullptr), 1e-11) << step;
    EXPECT_LT(medianRotationError(20, step, nullptr), 1e-10) << step;
    EXPECT_LT(medianRotationError(60, step, nullptr), 1e-6) << step;
  }
}

TEST(RungeKutta, FollowsAnIndependentIntegratorToFourthOrder) {
  const double coarse = medianRotationError(3, 1.0 / 60, flyRungeKutta);
  const double fine = medianRotationError(3, 1.0 / 240, flyRungeKutta);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 4, 0.4);
}

TEST(FlowWithoutLoads, OfTwoHalvesIsTheFlowOfTheWhole) {
  for (unsigned seed = 0; seed < kBodies; ++seed) {
    FreeBody body = bodyWithCoupledInertia(seed);
    setInMotion(body, seed, 10);
    const RigidState once = flowWithoutLoads(body, 0.04).state;
    body.state = flowWithoutLoads(body, 0.02).state;
    const RigidState twice = flowWithoutLoads(body, 0.02).state;
    EXPECT_LT((twice.position - once.position).norm(), 1e-13) << seed;
    EXPECT_LT(angleBetween(twice.orientation, once.orientation), 1e-13) << seed;
    EXPECT_LT((twice.twist.vector() - once.twist.vector()).norm(), 1e-12) << seed;
  }
}

TEST(FlowWithoutLoads, KeepsWorldMomentumThroughManyTurns) {
  // Velocity of a spinning sphere turns in body axes, thousands of times within one flow.
  Matrix6 inertia = Matrix6::Zero();
  inertia.bottomRightCorner<3, 3>().setIdentity();
  FreeBody ball({test::shapeWithoutFaces(inertia)});
  ball.state.twist = {{0, 0, 1e6}, {1, 2, 3}};
  const RigidState end = flowWithoutLoads(ball, 0.1).state;
  // Rounding is relative to the whole motion, 1e6, and accumulates over a thousand series.
  EXPECT_LT((end.orientation * end.twist.linear - Vector3(1, 2, 3)).norm(), 1e6 * 1e-14);
  EXPECT_LT((end.position - Vector3(0.1, 0.2, 0.3)).norm(), 1e5 * 1e-14);
}

TEST(FlowWithoutLoads, NeverGainsEnergyHoweverLong) {
  for (unsigned seed = 0; seed < kBodies; ++seed) {
    for (const double duration : {1.0, 1e3, 1e6}) {
      FreeBody body = bodyWithCoupledInertia(seed);
      setInMotion(body, seed, 100);
      const double before = body.kineticEnergy();
      body.state = flowWithoutLoads(body, duration).state;
      ASSERT_TRUE(body.state.isFinite()) << seed << " over " << duration;
      EXPECT_LE(body.kineticEnergy(), before * (1 + 1e-12)) << seed << " over " << duration;
    }
  }
}

TEST(FlowWithoutLoads, IsPreciseForHundredsOfRadiansAndTellsWhenItIsNot) {
  FreeBody body = bodyWithCoupledInertia(3);
  body.state.twist = {{100, 20, -30}, {1, 2, 3}};
  const double energy = body.kineticEnergy();
  const Flow far = flowWithoutLoads(body, 1);
  EXPECT_TRUE(far.is_precise);
  const Flow too_far = flowWithoutLoads(body, 30);
  EXPECT_FALSE(too_far.is_precise);
  body.state = far.state;
  EXPECT_NEAR(body.kineticEnergy(), energy, 1e-11 * energy);
  body.state = too_far.state;
  EXPECT_LE(body.kineticEnergy(), energy * (1 + 1e-12));
}

TEST(FlowWithoutLoads, LeavesABodyAtRestWhereItIs) {
  FreeBody body = bodyWithCoupledInertia(3);
  body.state.position = {1, 2, 3};
  const RigidState end = flowWithoutLoads(body, 1e6).state;
  EXPECT_EQ(end.position, body.state.position);
  EXPECT_EQ(end.orientation.coeffs(), body.state.orientation.coeffs());
  EXPECT_EQ(end.twist.vector(), Vector6(Vector6::Zero()));
}

using reference::AccelerationCase;

const reference::FullInertiaAccelerations kAnotherSimulator(AMBIENT_FULL_INERTIA);

FreeBody bodyOf(const AccelerationCase& c) {
  FreeBody body({test::shapeWithoutFaces(kAnotherSimulator.inertia - Matrix6::Identity(), 0)});
  body.state.orientation = Quaternion(c.orientation.normalized());
  const Quaternion to_body = body.state.orientation.conjugate();
  body.state.twist = {to_body * Vector3(c.angular_velocity), to_body * Vector3(c.linear_velocity)};
  body.surroundings.applied = {c.torque, c.force};
  return body;
}

Vector6 worldVelocity(const FreeBody& body) {
  return stack(body.state.orientation * body.state.twist.angular,
               body.state.orientation * body.state.twist.linear);
}

Vector6 expectedAcceleration(const AccelerationCase& c) {
  return stack(c.angular_acceleration, c.linear_acceleration);
}

TEST(RowVelocity, HasTheAccelerationsOfAnotherSimulator) {
  ASSERT_EQ(kAnotherSimulator.cases.size(), 5u);
  for (const AccelerationCase& c : kAnotherSimulator.cases) {
    const FreeBody body = bodyOf(c);
    constexpr double kStep = 1.0 / 1024;
    const RowVelocity row =
        computeRowVelocity({body.model(), body.surroundings, body.settings, kStep}, body.state);
    // Rows use half of the turning part.
    const Vector6 whole = row.change_W.vector() + row.turning_W.vector();
    const Vector6 error = whole / kStep - expectedAcceleration(c);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-12);  // uncertainty of the reference
  }
}

TEST(Leapfrog, HasTheAccelerationsOfAnotherSimulator) {
  for (const AccelerationCase& c : kAnotherSimulator.cases) {
    const auto central_difference = [&](double h) {
      FreeBody forwards = bodyOf(c);
      FreeBody backwards = bodyOf(c);  // time reversed
      backwards.state.twist = Twist::fromVector(-backwards.state.twist.vector());
      forwards.advance(h);
      backwards.advance(h);
      return Vector6((worldVelocity(forwards) + worldVelocity(backwards)) / (2 * h));
    };
    const Vector6 error =
        test::limitAtZero(central_difference, {0.1, 5, 2}) - expectedAcceleration(c);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace ambient
