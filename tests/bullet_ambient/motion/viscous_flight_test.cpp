#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

struct Ball {
  double diameter, density;
  Medium fluid;
  FlowSettings flow{};
};

test::FreeBodyDef bodyOf(const Ball& ball) {
  const double r = ball.diameter / 2, volume = 4 * kPi / 3 * r * r * r;
  test::FreeBodyDef def;
  def.shape.name = "ball";
  def.shape.sphere_radius = r;
  def.shape.volume = volume;
  def.shape.area = 4 * kPi * r * r;
  def.shape.added_mass.diagonal().tail<3>().setConstant(volume / 2);
  def.mass.mass = ball.density * volume;
  def.mass.inertia = 0.4 * def.mass.mass * r * r * Matrix3::Identity();
  def.medium = ball.fluid;
  def.flow = ball.flow;
  return def;
}

test::FreeBody bodyInGravity(const Ball& ball) {
  test::FreeBody body(bodyOf(ball));
  body.setGravity({0, 0, -9.81});
  return body;
}

Medium fluidOf(double density, double viscosity) {
  return {density, viscosity, {0, 0, 0}, {0, 0, 0}};
}

const Ball kSteelInGlycerine{0.004, 7850, fluidOf(1260, 1.41)};

TEST(ViscousFall, TerminalSpeedsAreThoseOfTheLawAtAnyStep) {
  const struct {
    Ball ball;
    double speed, seconds;
  } cases[] = {{kSteelInGlycerine, 0.039803, 1},
               {{1e-3, 2650, fluidOf(1000, 1e-3)}, 0.15773, 3},
               {{1e-4, 2650, fluidOf(1000, 1e-3)}, 0.0080817, 1},
               {{2e-5, 2000, fluidOf(1.2, 1.8e-5)}, 0.024067, 1}};
  for (const auto& [ball, speed, seconds] : cases) {
    double first = 0;
    for (const double rate : {30.0, 60.0, 1000.0}) {
      test::FreeBody body = bodyInGravity(ball);
      body.advance(1 / rate, static_cast<int>(seconds * rate));
      const double fallen = -body.state.twist.linear.z();
      EXPECT_NEAR(fallen / speed, 1, 3e-5) << ball.diameter << " m at " << rate << " Hz";
      if (first == 0) first = fallen;
      EXPECT_NEAR(fallen / first, 1, 1e-6) << ball.diameter << " m at " << rate << " Hz";
    }
  }
}

TEST(ViscousFall, FastModeIsAsRight) {
  Ball ball = kSteelInGlycerine;
  test::FreeBody body = bodyInGravity(ball);
  body.settings.max_substeps = 1;
  body.advance(1.0 / 30, 30);
  EXPECT_NEAR(-body.state.twist.linear.z() / 0.039803, 1, 3e-5);
}

TEST(ViscousFall, ASpinningBallFalls) {
  for (const Vector3& spin : {Vector3(0, 0, 0), Vector3(0, 0, 20), Vector3(0, 20, 0)}) {
    test::FreeBody body = bodyInGravity({0.2, 1050, fluidOf(1000, 1e-3)});
    body.state.twist.angular = spin;
    const double expected = spin.y() > 0 ? 2.768 : spin.z() > 0 ? 4.506 : 4.561;
    body.advance(1.0 / 60, 600);
    EXPECT_NEAR(-body.state.position.z() / expected, 1, 0.002) << spin.transpose();
  }
}

// Measured: 147 and 252 m.
TEST(ViscousFall, AGolfBallFliesAsFarAsTheLawSays) {
  Ball golf{0.0427, 0, fluidOf(1.204, 1.82e-5)};
  golf.density = 0.045 / (kPi / 6 * 0.0427 * 0.0427 * 0.0427);
  golf.flow.roughness = 2e-4;
  for (const auto& [speed, carry] : {std::pair{53.0, 139.62}, {78.68, 241.01}}) {
    test::FreeBody body = bodyInGravity(golf);
    const double angle = 10 * kPi / 180;
    body.state.twist = {{0, -2 * kPi * 42, 0},
                        {speed * std::cos(angle), 0, speed * std::sin(angle)}};
    do body.advance(1.0 / 240);
    while (body.state.position.z() > 0);
    EXPECT_NEAR(body.state.position.x(), carry, 0.2);  // the way of a step
  }
}

/// Six numbers of a motion under an arbitrary resistance.
struct Settled {
  Matrix6 inertia, inverse, resistance;

  explicit Settled(test::Arbitrary& arbitrary, double size)
      : inertia(arbitrary.positiveDefinite()),
        inverse(Cholesky<6>(inertia).inverse()),
        resistance(size * arbitrary.positiveDefinite()) {}
  Vector6 after(const Vector6& x, const Vector6& wrench, double q, double t) const {
    const SymmetricOf<double> K = plain(inertia), per_K = plain(inverse), C = plain(resistance);
    const Settling<double> terms(K, per_K, C);
    const DualPair fall{t * (inverse * wrench), t * wrench};
    return asEigen(settle<double>(plain(DualPair{x, inertia * x}), plain(fall), terms, q, t).twist);
  }
  double energy(const Vector6& x) const { return x.dot(inertia * x); }
};

TEST(Settling, OnlyTakesEnergyForAnyResistanceAndTime) {
  test::Arbitrary arbitrary(3);
  for (int i = 0; i < 500; ++i) {
    const Settled body(arbitrary, std::exp2(arbitrary.between(-30, 30)));
    const Vector6 x = arbitrary.twist().vector();
    const double q = std::exp2(arbitrary.between(-10, 10)),
                 t = std::exp2(arbitrary.between(-10, 10));
    EXPECT_LE(body.energy(body.after(x, Vector6::Zero(), q, t)), body.energy(x) * (1 + 1e-12));
  }
}

TEST(Settling, KeepsTheSteadyState) {
  test::Arbitrary arbitrary(4);
  for (int i = 0; i < 200; ++i) {
    const Settled body(arbitrary, std::exp2(arbitrary.between(-20, 20)));
    const Vector6 x = arbitrary.twist().vector();
    const double q = std::exp2(arbitrary.between(-10, 10));
    const Vector6 wrench = body.resistance * x + q * (body.inertia * x);
    EXPECT_LT((body.after(x, wrench, q, arbitrary.between(0.01, 10)) - x).norm(), 1e-9 * x.norm());
  }
}

TEST(Settling, IsOfSecondOrder) {
  test::Arbitrary arbitrary(5);
  const Settled body(arbitrary, 1);
  const Vector6 x = arbitrary.twist().vector(), wrench = arbitrary.twist().vector();
  const auto after = [&](int steps) {
    Vector6 y = x;
    for (int i = 0; i < steps; ++i) y = body.after(y, wrench, 0.7, 0.5 / steps);
    return y;
  };
  const Vector6 exact = after(4096);
  const double coarse = (after(128) - exact).norm(), fine = (after(256) - exact).norm();
  EXPECT_NEAR(coarse / fine, 4, 0.2);
}

TEST(ViscousFlight, BitsOfABodyDoNotDependOnItsNeighbours) {
  // A ball in an ideal fluid beside one in glycerine, and one whose mass is off its centre, which
  // has no diagonal inertia: each as alone.
  Ball ideal = kSteelInGlycerine;
  ideal.fluid.viscosity = 0;
  test::FreeBody alone = bodyInGravity(ideal), other = bodyInGravity(kSteelInGlycerine);
  const auto flightOf = [&](test::FreeBody& body) {
    return Flight({body.model(), body.surroundings, body.settings, 1.0 / 60}, body.state, {});
  };
  test::FreeBodyDef heavy = bodyOf(kSteelInGlycerine);
  heavy.frame.translation = {1e-4, 0, 2e-4};
  test::FreeBody odd(heavy);
  ASSERT_FALSE(odd.model().has_diagonal_inertia);
  for (test::FreeBody* body : {&alone, &other, &odd})
    body->state.twist = {{1, 2, -3}, {0.1, -0.2, 0.05}};
  Flight first = flightOf(alone), second = flightOf(other), third = flightOf(odd);
  Flight* all[] = {&first, &second, &third};
  flyTogether(all, 3);
  alone.advance(1.0 / 60);
  other.advance(1.0 / 60);
  EXPECT_EQ(first.body.state.twist.vector(), alone.state.twist.vector());
  EXPECT_EQ(second.body.state.twist.vector(), other.state.twist.vector());
  EXPECT_EQ(second.body.state.position, other.state.position);
}

// Munk's moment against the resistance to a turn. As a motion of its own between kicks it would
// turn this grain 15 times as far at 60 Hz as at 2000.
TEST(ViscousFlight, AGrainThatSinksAslantTurnsAsFarAtAnyStep) {
  const Vector3 axes(1.5e-3, 7e-4, 5e-4);
  const auto turnAt = [&](double rate) {
    test::FreeBodyDef def;
    def.shape = test::meshedEllipsoid(axes, 2);
    def.mass.mass = 7850 * def.shape.volume;
    def.mass.inertia = test::ellipsoidMoments(axes, def.mass.mass).asDiagonal();
    def.medium = fluidOf(1260, 1.41);
    test::FreeBody body(def);
    body.setGravity({0, 0, -9.81});
    body.state.orientation = Quaternion(Eigen::AngleAxisd(kPi / 4, Vector3::UnitY()));
    const Quaternion start = body.state.orientation;
    body.advance(1 / rate, static_cast<int>(rate));
    return start.angularDistance(body.state.orientation);
  };
  const double exact = turnAt(2000);
  EXPECT_GT(exact, 1e-4);
  for (const double rate : {30.0, 60.0, 240.0}) EXPECT_NEAR(turnAt(rate) / exact, 1, 0.05) << rate;
}

// The way of a ball that spins does not turn with it.
TEST(ViscousFlight, ASpinDoesNotTurnTheWayOfABall) {
  test::FreeBody body = bodyInGravity(kSteelInGlycerine);
  body.surroundings = {};
  body.state.twist = {{0, 0, 300}, {0.5, 0, 0}};
  body.advance(1.0 / 60);
  EXPECT_LT(std::abs(body.state.position.y()), 0.02 * body.state.position.x());
}

TEST(ViscousFlight, WithoutViscosityABallFallsAsItsClosedFormSays) {
  Ball ball{0.1, 2000, fluidOf(1000, 0)};
  test::FreeBody body = bodyInGravity(ball);
  const double volume = kPi / 6 * 1e-3, net = 1000 * volume * 9.81, section = kPi / 4 * 0.01;
  const double terminal = std::sqrt(2 * net / (1000 * section * 0.5));
  const double time = 2500 * volume * terminal / net;
  body.advance(1.0 / 240, 240);
  EXPECT_NEAR(-body.state.twist.linear.z(), terminal * std::tanh(1 / time), 2e-3 * terminal);
}

}  // namespace
}  // namespace ambient
