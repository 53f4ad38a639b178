#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::FreeBody;

FreeBody bodyWithCoupledInertia(Arbitrary& arbitrary) {
  return FreeBody({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
}

// Applies a kick; `x`, wrench and sampled twist as vectors.
Vector6 kicked(const FreeBody& body, const Vector6& x, const Vector6& sampled_twist,
               const Vector6& wrench, double duration) {
  const PairsOf<double> at = plain(pairOfTwist(body.model(), sampled_twist));
  const PairsOf<double> load = plain(pairOfMomentum(body.model(), wrench));
  return asEigen(passiveKick(plain(pairOfTwist(body.model(), x)), at, load, duration).twist);
}

TEST(PassiveKick, NeverGainsEnergyHoweverLongAndStrong) {
  Arbitrary arbitrary(1);
  for (int i = 0; i < 2000; ++i) {
    const FreeBody body = bodyWithCoupledInertia(arbitrary);
    const Vector6 x = arbitrary.twist(10, 10).vector();
    const Vector6 sampled = arbitrary.twist(10, 10).vector();
    const Vector6 load = std::pow(10.0, arbitrary.between(-10, 30)) * arbitrary.twist().vector();
    const double duration = std::pow(10.0, arbitrary.between(-6, 6));
    const Vector6 end = kicked(body, x, sampled, load, duration);
    ASSERT_TRUE(end.allFinite());
    // Rounding of a rotation in the norm of K.
    EXPECT_LE(inertiaNormSquared(body.model(), end),
              inertiaNormSquared(body.model(), x) * (1 + 1e-13));
  }
}

TEST(PassiveKick, IsTheLoadTimesTheTimeAtFirst) {
  Arbitrary arbitrary(2);
  for (int i = 0; i < 100; ++i) {
    const FreeBody body = bodyWithCoupledInertia(arbitrary);
    const Vector6 x = arbitrary.twist().vector();
    Vector6 F = arbitrary.twist().vector();
    if (F.dot(x) > 0) F = -F;  // braking load
    constexpr double kTime = 1e-6;
    const Vector6 change = kicked(body, x, x, F, kTime) - x;
    const Vector6 expected = kTime * (body.model().inverse_inertia * F);
    // Error of second order in time; rates are about |K^-1 F| / |x|, up to some hundred here.
    EXPECT_LT((change - expected).norm(), 1e-3 * expected.norm());
  }
}

TEST(PassiveKick, IsTheExactQuadraticDecayForDragAlone) {
  // m v' = -c v |v|: v = v_0 / (1 + c v_0 t / m).
  Arbitrary arbitrary(3);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const double speed = std::sqrt(inertiaNormSquared(body.model(), x));
  const Vector6 along = 0.7 * x;  // other sampled speed
  const double sampled_speed = 0.7 * speed;
  constexpr double c = 0.3;
  const Vector6 drag = -c * sampled_speed * (body.model().inertia * along);
  for (const double time : {1e-9, 1.0, 1e3, 1e9}) {
    const Vector6 end = kicked(body, x, along, drag, time);
    EXPECT_LT((end - x / (1 + c * speed * time)).norm(), 1e-14 * x.norm()) << time;
  }
}

TEST(PassiveKick, TurnsWithoutLossUnderLiftAlone) {
  // |x| stays constant; x turns in the plane of sample and lift at the rate |a| / |x|.
  Arbitrary arbitrary(4);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Matrix6& K = body.model().inertia;
  const Vector6 x = arbitrary.twist().vector();
  Vector6 lift = arbitrary.twist().vector();
  lift -= x * (x.dot(K * lift) / x.dot(K * x));  // acceleration across the motion
  const double rate = std::sqrt(lift.dot(K * lift) / x.dot(K * x));
  for (const double angle : {0.1, 1.0, 10.0}) {
    const Vector6 end = kicked(body, x, x, K * lift, angle / rate);
    const Vector6 expected = std::cos(angle) * x + std::sin(angle) / rate * lift;
    EXPECT_LT((end - expected).norm(), 1e-13 * x.norm()) << angle;
  }
}

TEST(PassiveKick, OfTwoHalvesIsTheKickOfTheWhole) {
  // Drag and lift, sampled at the present motion in each step: the rule is exact.
  Arbitrary arbitrary(5);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Matrix6& K = body.model().inertia;
  const Vector6 x = arbitrary.twist().vector();
  Vector6 a = arbitrary.twist().vector();
  a -= x * (x.dot(K * a) / x.dot(K * x));
  const Vector6 load = K * (a - 0.4 * x);
  const Vector6 once = kicked(body, x, x, load, 0.8);
  const Vector6 twice = kicked(body, kicked(body, x, x, load, 0.4), x, load, 0.4);
  EXPECT_LT((twice - once).norm(), 1e-14 * x.norm());
}

TEST(PassiveKick, TakesNoPowerFromALoadThatWouldGiveIt) {
  Arbitrary arbitrary(6);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const Vector6 pushing = body.model().inertia * x;
  EXPECT_LT((kicked(body, x, x, pushing, 1.0) - x).norm(), 1e-14 * x.norm());
}

TEST(PassiveKick, LeavesMotionAloneWithoutLoadOrWithoutSample) {
  Arbitrary arbitrary(7);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const Vector6 F = arbitrary.twist().vector();
  const Vector6 zero = Vector6::Zero();
  EXPECT_EQ(kicked(body, x, x, zero, 1e6), x);
  EXPECT_EQ(kicked(body, x, zero, F, 1e6), x);
  EXPECT_EQ(kicked(body, zero, x, F, 1e6), zero);
}

TEST(PassiveKick, DoesNotHideALoadThatIsNotFinite) {
  Arbitrary arbitrary(8);
  const FreeBody body = bodyWithCoupledInertia(arbitrary);
  const Vector6 x = arbitrary.twist().vector();
  const Vector6 broken = Vector6::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(kicked(body, x, x, broken, 1.0).allFinite());
}

using test::Arbitrary;
using test::FreeBody;

constexpr int kRandomBodies = 1200;

// Random body from needle to plate, mass centre anywhere inside, density 1e-3 to 1e4 of the
// fluid's, up to 300 m/s and 1000 rad/s.
FreeBody wildBody(Arbitrary& arbitrary) {
  const auto power = [&](double low, double high) {
    return std::pow(10.0, arbitrary.between(low, high));
  };
  const double size = power(-2, 0.5);
  const Vector3 semi_axes = size * Vector3{power(-1, 0), power(-1, 0), power(-1, 0)};
  const Medium medium = arbitrary.between(0, 1) < 0.5 ? air() : water();
  const FluidBody shape = test::meshedEllipsoid(semi_axes, 1);
  const double mass = power(-3, 4) * medium.density * shape.volume;
  FrameOffset frame;
  frame.rotation = arbitrary.rotation();
  frame.translation = 0.3 * arbitrary.between(0, 1) * semi_axes.minCoeff() * arbitrary.vector();
  const FlowSettings flow{arbitrary.between(kPi / 2, kPi), arbitrary.between(0, 1) < 0.5};
  const Vector3 moments = test::ellipsoidMoments(semi_axes, mass);
  FreeBody body({shape, {mass, moments.asDiagonal()}, medium, flow, frame});
  body.state.orientation = Quaternion(arbitrary.rotation());
  body.state.twist = {power(-1, 3) * arbitrary.vector().normalized(),
                      power(-1, std::log10(300)) * arbitrary.vector().normalized()};
  return body;
}

double wildStep(Arbitrary& arbitrary) {
  return std::exp(arbitrary.between(std::log(1.0 / 960), std::log(1.0 / 30)));
}

TEST(Leapfrog, NeverGainsEnergyInAStillFluid) {
  Arbitrary arbitrary(1);
  double largest_growth = 0;
  int finite = 0;
  for (int i = 0; i < kRandomBodies; ++i) {
    FreeBody body = wildBody(arbitrary);
    const double step = wildStep(arbitrary);
    for (int n = 0; n < 10; ++n) {
      const double before = body.kineticEnergy();
      body.advance(step);
      if (!body.state.isFinite()) break;
      largest_growth = std::max(largest_growth, body.kineticEnergy() / before - 1);
    }
    finite += body.state.isFinite();
  }
  EXPECT_EQ(finite, kRandomBodies);
  // Tolerance is rounding: each kick and each flow is passive. Measured 6e-13.
  EXPECT_LT(largest_growth, 1e-11);
}

// Eq. (25a) forbids gains; 343 of these 6000 steps would gain without it.
TEST(Leapfrog, NeverGainsEnergyInGravity) {
  Arbitrary arbitrary(3);
  int falls = 0;
  for (int i = 0; i < kRandomBodies / 2; ++i) {
    FreeBody body = wildBody(arbitrary);
    if (i % 2 == 0) body.state.twist = arbitrary.twist(3, 1);
    body.setGravity({0, 0, -9.81});
    const double step = wildStep(arbitrary);
    for (int n = 0; n < 20; ++n) {
      const double before = body.totalEnergy(), kinetic = body.kineticEnergy();
      const Vector3 from = body.state.position;
      body.advance(step);
      ASSERT_TRUE(body.state.isFinite()) << i;
      const double weight = body.model().mass * 9.81;
      const double moved = kinetic + body.kineticEnergy() +
                           weight * (body.state.position - from).norm() + std::abs(before);
      // Tolerance: rounding of the energy.
      EXPECT_LE(body.totalEnergy() - before, 1e-13 * moved) << i << " step " << n;
      falls += kinetic > 0;
    }
  }
  EXPECT_EQ(falls, 20 * (kRandomBodies / 2));
}

// Zero loads: eq. (25a) causes all losses of energy.
class NoLoads final : public SurfaceLoads {
 public:
  Wrench load(const Twist&) const noexcept override { return {}; }
  bool needsGuard() const noexcept override { return false; }
};

TEST(Leapfrog, CountsTheEnergyThatItsBoundRemoves) {
  Arbitrary arbitrary(3);
  int bounded = 0;
  for (int i = 0; i < 100; ++i) {
    FreeBody body = wildBody(arbitrary);
    body.state.twist = arbitrary.twist(3, 1);
    body.setGravity({0, 0, -9.81});
    BodyModel free = body.model(), loaded = body.model();
    free.loads = nullptr;
    loaded.loads = std::make_shared<NoLoads>();
    free.resistance = loaded.resistance = nullptr;
    const double before = body.totalEnergy(), step = wildStep(arbitrary);
    const FlightSettings one{1e-6, 1};
    const RigidState start = body.state;
    body.state = fly({free, body.surroundings, one, step}, start, {}).state;
    const double gain = body.totalEnergy() - before, moved = body.kineticEnergy();
    const FlightResult result = fly({loaded, body.surroundings, one, step}, start, {});
    EXPECT_NEAR(result.count.energy_removed, std::max(0.0, gain), 1e-9 * moved) << i;
    bounded += gain > 1e-6 * moved;
  }
  EXPECT_GT(bounded, 10);
}

// A plate like a flake of air in water flutters upwards. Where it slides down a step is longer than
// the time in which the water stops it: what it has cannot pay for its way, eq. (25a).
TEST(Leapfrog, AFlakeThatFluttersNeverGainsEnergy) {
  for (int seed = 1; seed <= 20; ++seed) {
    Arbitrary arbitrary(static_cast<unsigned>(seed));
    const Vector3 semi_axes(5e-4, 5e-4, 2.5e-6);
    const FluidBody shape = test::meshedEllipsoid(semi_axes, 1);
    const double mass = 1e-3 * water().density * shape.volume;
    FreeBody body(
        {shape, {mass, test::ellipsoidMoments(semi_axes, mass).asDiagonal()}, water(), {}});
    body.setGravity({0, 0, -9.81});
    body.state.orientation = Quaternion(arbitrary.rotation());
    body.state.twist = arbitrary.twist(10, 1);
    for (int n = 0; n < 240; ++n) {
      const double before = body.totalEnergy();
      body.advance(1.0 / 120);
      EXPECT_LE(body.totalEnergy() - before, 1e-13 * std::abs(before)) << seed << " step " << n;
    }
  }
}

// Largest relative change of energy of a swing, in the first and last tenth of a minute. The body
// has no faces and swings about its centre of volume.
struct EnergySwing {
  double early = 0, late = 0;
};
EnergySwing measureEnergySwing(double step) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  FrameOffset frame;
  frame.translation = {0, 0, 0.05};
  constexpr double kMass = 2;
  FreeBody body({test::facelessEllipsoid(semi_axes),
                 {kMass, test::ellipsoidMoments(semi_axes, kMass).asDiagonal()},
                 {1000, 0, Vector3::Zero(), Vector3::Zero()},
                 {},
                 frame});
  // Weight equals lift: the body swings without rising.
  const double lift = 9.81 * body.model().displaced_mass;
  body.surroundings.gravity = {0, 0, -9.81};
  body.surroundings.applied.force = {0, 0, -lift};
  body.state.orientation = Quaternion(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitX()));
  const auto energy = [&] {
    return body.kineticEnergy() -
           lift * (body.state.orientation * body.model().centre_of_volume).z();
  };
  const double start = energy();
  const int steps = static_cast<int>(std::lround(60 / step));
  EnergySwing swing;
  for (int i = 0; i < steps; ++i) {
    body.advance(step);
    const double change = std::abs(energy() / start - 1);
    if (i < steps / 10) swing.early = std::max(swing.early, change);
    if (i >= steps - steps / 10) swing.late = std::max(swing.late, change);
  }
  return swing;
}

TEST(Leapfrog, TotalEnergyUnderGravityWithoutLoadsSwingsToSecondOrderAndDoesNotDrift) {
  const EnergySwing coarse = measureEnergySwing(1.0 / 60);
  const EnergySwing fine = measureEnergySwing(1.0 / 240);
  EXPECT_NEAR(std::log2(coarse.early / fine.early) / 2, 2, 0.1);
  EXPECT_LT(coarse.early, 2e-2);  // measured 1.3e-2: five steps per radian
  EXPECT_LT(coarse.late, 1.05 * coarse.early);
  EXPECT_LT(fine.late, 1.05 * fine.early);
}

}  // namespace
}  // namespace ambient
