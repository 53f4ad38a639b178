#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/surface/hold_water.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "tests/bullet_ambient/motion/surface/barge_runs.h"
#include "tests/support/bodies/random_bodies.h"

// Pendulums of the water in a hold, docs/theory.md section 20.
namespace ambient {
namespace {

using test::Arbitrary;
using test::FloatingDef;
using test::FloatingRun;
using namespace test::barge;

constexpr double kInside = 0.2, kPull = 9.81;

/// The barge's hold with its water, in the frame of the centre of mass at a height.
struct BargeWater {
  explicit BargeWater(double above_keel)
      : hold(test::boxHold({1.96, 0.96, 0.48}, {0, 0, 0.26 - above_keel})),
        shape(hold),
        fill(fillHold(shape, {0, 0, 1}, kInside, std::numeric_limits<double>::quiet_NaN())),
        modes(modesOf(shape, fill, {{0, 0, 1}, 0, 1000, kPull})) {}

  SloshingAt at(const Matrix3& to_world = Matrix3::Identity()) const {
    return {1000, &modes, 1, to_world};
  }
  const SloshMode& across() const {
    return modes.modes[std::abs(modes.modes[0].axis.y()) > 0.7 ? 0 : 1];
  }

  Hold hold;
  HoldShape shape;
  HoldFill fill;
  HoldModes modes;
};

// Where the vessel cannot move, a step turns way and velocity by 2 atan(omega t / 2).
TEST(Sloshing, OfAVesselThatIsHeldIsTheMidpointRule) {
  const BargeWater water(0.16);
  const SloshMode& mode = water.across();
  const double rate = std::sqrt(mode.square), step = 0.05;
  EXPECT_NEAR(rate, 3.2768, 1e-4);
  constexpr double kWay = 1e-7;  // far from the floor
  Sloshing state{true, {0, kWay, 0}, {0, 0, 0}};
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) {
    const Vector6 x =
        exchangeSloshing(water.at(), SymmetricMatrix(), 0, step, Vector6::Zero(), &state).twist;
    EXPECT_EQ(x.norm(), 0);
  }
  const double turned = kSteps * 2 * std::atan(rate * step / 2);
  EXPECT_NEAR(state.displacement_W.y(), kWay * std::cos(turned), 1e-10 * kWay);
  EXPECT_NEAR(state.velocity_W.y(), -kWay * rate * std::sin(turned), 1e-10 * kWay);
}

TEST(Sloshing, IsDampedByItsShareOfTheCriticalDamping) {
  const BargeWater water(0.16);
  const double rate = std::sqrt(water.across().square);
  for (const double damping : {0.03, 0.1}) {
    Sloshing state{true, {0, 1e-5, 0}, {0, 0, 0}};
    constexpr double kStep = 1e-3;
    double last = 0, highest = 0;
    const int steps = static_cast<int>(3.5 * 2 * kPi / rate / kStep);
    for (int i = 0; i < steps; ++i) {
      exchangeSloshing(water.at(), SymmetricMatrix(), damping, kStep, Vector6::Zero(), &state);
      if (state.displacement_W.y() > last && i > steps * 5 / 7)
        highest = std::max(highest, state.displacement_W.y());
      last = state.displacement_W.y();
    }
    const double period = 2 * kPi / (rate * std::sqrt(1 - damping * damping));
    EXPECT_NEAR(highest, 1e-5 * std::exp(-damping * rate * 3 * period), 1e-2 * highest);
  }
}

TEST(Sloshing, KeepsMomentumAndEnergyWithAnyBody) {
  Arbitrary arbitrary(31);
  for (int i = 0; i < 100; ++i) {
    const BargeWater water(arbitrary.between(0, 0.5));
    Matrix6 root;
    for (int k = 0; k < 6; ++k) root.col(k) = stack(arbitrary.vector(), arbitrary.vector());
    const Matrix6 inertia = 100 * root * root.transpose() + Matrix6::Identity();
    const Matrix3 R = rotationFromVector(arbitrary.vector()).toRotationMatrix();
    const SloshingAt at = water.at(R);
    Sloshing state{true, R * arbitrary.vector(), R * arbitrary.vector()};
    const Vector6 x = stack(arbitrary.vector(), arbitrary.vector());
    const auto energyOf = [&](const Vector6& twist) {
      return twist.dot(inertia * twist) / 2 + energyOfSloshing(at, &state).sum();
    };
    const auto momentumOf = [&](const Vector6& twist) -> Vector6 {
      const Momentum m = momentumOfSloshing(at, &state);
      return inertia * twist + stack(R.transpose() * m.angular, R.transpose() * m.linear);
    };
    const double energy = energyOf(x);
    const Vector6 momentum = momentumOf(x);
    const double damping = i % 2 == 0 ? 0.1 : 0, step = std::pow(10, arbitrary.between(-3, 1));
    const Vector6 end = exchangeSloshing(at, SymmetricMatrix(Cholesky<6>(inertia).inverse()),
                                         damping, step, x, &state)
                            .twist;
    EXPECT_LT((momentumOf(end) - momentum).norm(), 1e-9 * momentum.norm());
    if (damping > 0) {
      EXPECT_LT(energyOf(end), energy);
    } else {
      // Waves that reach the floor lose some, too.
      EXPECT_LT(energyOf(end), energy * (1 + 1e-12));
    }
  }
}

/// Linear system of roll, sway and the pendulum across for inertias of body and fluid.
struct RollingBarge {
  RollingBarge(double above_keel, double roll, double coupling, double sway) {
    const BargeWater water(above_keel);
    const SloshMode& mode = water.across();
    mass = 1000 * mode.volume;
    stiffness = mass * mode.square;
    arm = {mode.pivot.z(), -1};
    inertia << roll, coupling, coupling, sway;
    const double depth = kInside / (1.96 * 0.96), draught = draughtOf(kInside);
    const double outer = 2.0 / 12 + 2 * draught * (draught / 2 - above_keel);
    const double inner = 1.96 * std::pow(0.96, 3) / 12 + kInside * (0.02 + depth / 2 - above_keel);
    righting = 1000 * kPull * (outer - inner);
  }

  /// Accelerations of roll, sway and pendulum at ways of them.
  Vector3 accelerations(const Vector3& ways) const {
    const double force = stiffness * (ways.z() + arm.dot(ways.head<2>()));
    const Eigen::Vector2d push = -force * arm - righting * ways.x() * Eigen::Vector2d::UnitX();
    const Eigen::Vector2d moved = inertia.inverse() * push;
    return {moved.x(), moved.y(), -force / mass};
  }
  /// The two natural frequencies [1/s].
  std::array<double, 2> rates() const {
    Matrix3 system;
    for (int i = 0; i < 3; ++i) system.col(i) = -accelerations(Vector3::Unit(i));
    const double sum = system.trace(), product = (sum * sum - (system * system).trace()) / 2,
                 root = std::sqrt(sum * sum / 4 - product);
    return {std::sqrt(sum / 2 - root), std::sqrt(sum / 2 + root)};
  }

  double mass, stiffness, righting;
  Eigen::Vector2d arm;  ///< less the velocity of the pivot along y in roll and sway
  Eigen::Matrix2d inertia;
};

// A barge of 0.16 m to its centre of mass, with 41 kg m^2 in roll and 450 kg in sway.
TEST(Sloshing, RollAndPendulumHaveTheKnownFrequencies) {
  const BargeWater water(0.16);
  const Matrix6 inside = 1000 * carriedInertia(water.fill.water.volume, water.modes);
  const auto [slow, fast] =
      RollingBarge(0.16, 41 + inside(0, 0), inside(0, 4), 450 + inside(4, 4)).rates();
  EXPECT_NEAR(slow, 1.0799, 1e-4);
  EXPECT_NEAR(fast, 5.8451, 1e-4);
}

FloatingDef quietBarge(double above_keel) {
  FloatingDef def = bargeDef(above_keel);
  def.gyration = {0.36, 0.65, 0.7};
  def.wave_damping = 0;
  return def;
}

// The barge afloat, heeled by 0.01 rad and let go, follows the linear system.
TEST(Sloshing, RollOfABargeIsThatOfTheLinearSystem) {
  for (const double hertz : {60.0, 240.0}) {
    FloatingRun run(quietBarge(0.16));
    run.water = {{kInside}};
    run.sloshing_damping = 0;
    setAfloat(run, 0.16, 0);
    const Matrix6 K = run.inertia();
    const RollingBarge linear(0.16, K(0, 0), K(0, 4), K(4, 4));
    constexpr double kHeel = 0.01, kFine = 1e-3;
    setAfloat(run, 0.16, kHeel);
    Vector3 ways(kHeel, 0, -linear.arm.x() * kHeel), rates(0, 0, 0);
    double error = 0;
    for (int i = 0; i < static_cast<int>(8 * hertz); ++i) {
      run.step(1 / hertz);
      const int fine = static_cast<int>(std::lround(1 / hertz / kFine)) + 1;
      const double step = 1 / hertz / fine;
      for (int k = 0; k < fine; ++k) {  // leapfrog
        rates += step / 2 * linear.accelerations(ways);
        ways += step * rates;
        rates += step / 2 * linear.accelerations(ways);
      }
      const Vector3 across = run.state.orientation * Vector3(0, 1, 0);
      error = std::max(error, std::abs(across.z() - ways.x()));
    }
    EXPECT_LT(error, 0.1 * kHeel) << hertz;
  }
}

// Nothing takes energy from a barge that rocks a little, without waves outside and friction.
TEST(Sloshing, RockingBargeKeepsItsEnergy) {
  for (const double hertz : {60.0, 240.0}) {
    FloatingRun run(quietBarge(0.16));
    run.water = {{kInside}};
    run.sloshing_damping = 0;
    setAfloat(run, 0.16, 0);
    const double low = run.energy();
    run.state.orientation = rotationFromVector(Vector3(0.01, 0.003, 0));
    run.state.twist = {{0, 0.01, 0}, {0, 0.01, 0.005}};
    const double first = run.energy() - low;
    run.run(20, 1 / hertz);
    EXPECT_GT(run.energy() - low, 0.9 * first) << hertz;
    EXPECT_LT(run.energy() - low, first);
  }
}

// No force acts along the sea.
TEST(Sloshing, KeepsTheMomentumAlongTheSea) {
  FloatingRun run(quietBarge(0.16));
  run.water = {{kInside}};
  setAfloat(run, 0.16, 0);
  run.state.orientation = rotationFromVector(Vector3(0.1, 0.03, 0.5));
  run.state.twist = {{0.1, 0.2, 0.3}, {0.4, 0.1, 0}};
  const auto momentum = [&] {
    const Flotation flotation = run.flotation();
    const WaterAt at{run.model(), flotation, run.state.orientation.toRotationMatrix(),
                     run.state.position};
    const Momentum of_water = momentumOfSloshing(at.sloshing(), run.sloshing.now.data());
    return Vector3(run.momentum_W() + of_water.linear);
  };
  run.step(1 / 60.0);
  const Vector3 before = momentum();
  for (int i = 0; i < 120; ++i) run.step(1 / 60.0);
  EXPECT_LT((momentum() - before).head<2>().norm(), 0.02 * before.norm());
}

TEST(Sloshing, ShiftKeepsMomentumAndEnergy) {
  Arbitrary arbitrary(3);
  FloatingRun run(bargeDef(0.2));
  run.water = {{0.3}};
  run.sloshing.resize(1);
  int kept = 0;
  for (int i = 0; i < 50; ++i) {
    setAfloat(run, 0.2, 0.2 * arbitrary.between(-1, 1));
    const Flotation before = run.flotation();
    const Matrix3 R = run.state.orientation.toRotationMatrix();
    Sloshing state{true, 0.01 * arbitrary.vector(), 0.1 * arbitrary.vector()};
    const WaterAt there{run.model(), before, R, run.state.position};
    const WaterLeft left(there, &state, energyOfSloshing(there.sloshing(), &state).sum());
    run.state.orientation =
        rotationFromVector(0.02 * arbitrary.vector().normalized()) * run.state.orientation;
    run.state.position += 0.01 * arbitrary.vector();
    const Flotation after = run.flotation();
    const WaterAt at{run.model(), after, run.state.orientation.toRotationMatrix(),
                     run.state.position};
    SymmetricMatrix inertia = before.inertia;
    const Vector6 x = stack(arbitrary.vector().normalized(), arbitrary.vector().normalized());
    const Vector6 end = shiftWater(left, at, x, inertia, &state);
    const double energy = x.dot(before.inertia.full() * x) / 2 + left.energy;
    const double energy_after =
        end.dot(inertia.full() * end) / 2 + energyOfSloshing(at.sloshing(), &state).sum();
    EXPECT_LT(energy_after, energy * (1 + 1e-14));
    const auto turned = [&](const Vector6& own) {
      return stack(at.to_world * own.head<3>(), at.to_world * own.tail<3>());
    };
    const Vector3 way = at.position_W - left.position_W;
    const Vector3& linear = left.momentum_W.linear;
    const Vector6 momentum = turned(before.inertia.full() * x) +
                             stack(left.momentum_W.angular - way.cross(linear), linear);
    const Vector6 change = turned(inertia.full() * end) +
                           momentumOfSloshing(at.sloshing(), &state).vector() - momentum;
    // Where no torque along the tilt keeps the energy, the twist is scaled within it.
    if (change.tail<3>().norm() > 1e-6 * momentum.norm() || energy_after < energy * (1 - 1e-12))
      continue;
    ++kept;
    EXPECT_LT(change.tail<3>().norm(), 1e-11 * momentum.norm());
    EXPECT_LT(std::abs(change[2]), 1e-11 * momentum.norm());
    EXPECT_GT(change.norm(), 0);
  }
  EXPECT_GT(kept, 40);
}

// Water keeps its way while the vessel turns under it, and no energy comes of it.
TEST(Sloshing, NeverGrowsWithItsModes) {
  Arbitrary arbitrary(32);
  const BargeWater water(0.16);
  for (int i = 0; i < 100; ++i) {
    Sloshing state{true, arbitrary.vector(), arbitrary.vector()};
    const double energy = energyOfSloshing(water.at(), &state).sum();
    const Matrix3 R = rotationFromVector(arbitrary.vector()).toRotationMatrix();
    projectOnModes(water.at(R), energy, &state);
    EXPECT_LT(energyOfSloshing(water.at(R), &state).sum(), energy * (1 + 1e-14));
    EXPECT_NEAR(state.displacement_W.dot(R.col(2)), 0, 1e-12);
  }
  const HoldModes none;
  Sloshing state{true, {1, 0, 0}, {0, 1, 0}};
  projectOnModes({1000, &none, 1, Matrix3::Identity()}, 1, &state);
  EXPECT_EQ(state.displacement_W.norm() + state.velocity_W.norm(), 0);
}

}  // namespace
}  // namespace ambient
