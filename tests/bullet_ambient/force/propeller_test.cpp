// Propellers by their numbers, docs/theory.md section 22.

#include "bullet_ambient/force/law/propeller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

constexpr double kSeaDensity = 998;

WageningenScrew b455() { return {4, 0.55, 1}; }

/// K_T and K_Q that load() gives at J.
PropellerPoint seen(const Propeller& propeller, double advance, double turns = 3) {
  const double d = propeller.diameter(), scale = kSeaDensity * turns * turns * std::pow(d, 4);
  const PropellerLoad load = propeller.load(turns, advance * std::abs(turns) * d, kSeaDensity);
  return {advance, load.thrust / scale, load.torque / (scale * d)};
}

// J, K_T and 10 K_Q of B4-55, P/D 1, to four digits: issue 53. The table of 128 points adds 2e-6.
TEST(Propeller, HasTheDiagramOfB455) {
  const double points[][3] = {{0, .4243, .6129},
                              {0.2, .3716, .5477},
                              {0.4, .3038, .4655},
                              {0.6, .2241, .3657},
                              {0.8, .1356, .2477}};
  const Propeller screw = Propeller::wageningen(0.4, b455());
  for (const auto& [advance, thrust, torque] : points) {
    EXPECT_NEAR(wageningenPoint(b455(), advance).thrust, thrust, 5e-5);
    EXPECT_NEAR(10 * wageningenPoint(b455(), advance).torque, torque, 5e-5);
    EXPECT_NEAR(seen(screw, advance).thrust, wageningenPoint(b455(), advance).thrust, 3e-6);
    EXPECT_NEAR(seen(screw, advance).torque, wageningenPoint(b455(), advance).torque, 3e-7);
  }
}

std::vector<PropellerPoint> openWater() {
  return {{0, 0.11, 0.012}, {0.3, 0.09, 0.0115}, {0.5, 0.055, 0.0095}, {0.72, -0.01, 0.003}};
}

TEST(Propeller, HasItsTablesPointsAndLinesBetween) {
  const Propeller propeller = Propeller::byTable(0.25, openWater());
  const std::vector<PropellerPoint> points = openWater();
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(seen(propeller, points[i].advance).thrust, points[i].thrust, 1e-15);
    EXPECT_NEAR(seen(propeller, points[i].advance).torque, points[i].torque, 1e-15);
  }
  EXPECT_NEAR(seen(propeller, 0.45).thrust, 0.055 + 0.25 * 0.035, 1e-15);
  EXPECT_NEAR(seen(propeller, 0.45).torque, 0.0095 + 0.25 * 0.002, 1e-15);
  // Backwards, the mirror image, with a share of its own.
  EXPECT_NEAR(seen(propeller, -0.3, -3).thrust, -0.09, 1e-15);
  EXPECT_NEAR(seen(propeller, -0.3, -3).torque, -0.0115, 1e-15);
  const Propeller cambered = Propeller::byTable(0.25, openWater(), {0.3, 0.7});
  EXPECT_NEAR(seen(cambered, -0.3, -3).thrust, -0.7 * 0.09, 1e-15);
}

// T = 2 rho A W (W - V), P = T W: momentum theory, with the power of the thrust at rest.
TEST(Propeller, IsAnIdealDiscByMomentumTheory) {
  const Propeller disc = Propeller::idealDisc(0.3);
  const double mass = kSeaDensity * kPi / 4 * 0.09;
  for (const double rest : {20.0, -20.0})
    for (const double advance : {-8.0, -1.0, -0.1, 0.0, 0.2, 1.0, 8.0}) {
      const PropellerLoad load = disc.load(rest, advance, kSeaDensity);
      const double through = advance + load.induced;
      EXPECT_NEAR(load.power, std::pow(20, 1.5) / std::sqrt(2 * mass), 1e-12);
      EXPECT_NEAR(load.thrust * through, load.power, 1e-12 * load.power);
      const double momentum = 2 * mass * std::abs(through) * load.induced;
      EXPECT_NEAR(load.thrust, momentum, 1e-12 * std::abs(momentum));
      if (advance == 0) {
        EXPECT_NEAR(load.thrust, rest, 1e-12);
      }
    }
  EXPECT_EQ(disc.load(0, 3, kSeaDensity).thrust, 0);
  EXPECT_EQ(disc.load(20, 3, 0).thrust, 0);
}

// Eq. (162): momentum theory where it holds, continuous where it does not.
TEST(Propeller, InducesWhatMomentumTheorySays) {
  const double thrust = 7, mass = 2, rest = std::sqrt(thrust / (2 * mass));
  for (const double advance : {-9.0, -2.0 * rest, 0.0, 0.5, 9.0}) {
    const double induced = inducedVelocity(thrust, advance, mass);
    EXPECT_NEAR(2 * mass * std::abs(advance + induced) * induced, thrust, 1e-13 * thrust);
    EXPECT_EQ(inducedVelocity(-thrust, -advance, mass), -induced);
  }
  for (const double at : {-2 * rest, 0.0})
    EXPECT_NEAR(inducedVelocity(thrust, at - 1e-9, mass), inducedVelocity(thrust, at + 1e-9, mass),
                1e-4);
}

std::vector<Propeller> allPropellers() {
  std::vector<Propeller> kinds{Propeller::byTable(0.25, openWater()),
                               Propeller::byTable(0.25, {{0, 0.1, 0.02}, {0.5, 0.06, 0.015}}),
                               Propeller::byTable(0.25, openWater(), {1.5, 0.6})};
  for (const int blades : {2, 4, 7})
    for (const double area : {0.3, 0.55, 1.05})
      for (const double pitch : {0.5, 0.8, 1.1, 1.4})
        kinds.push_back(Propeller::wageningen(0.25, {blades, area, pitch, 0.75}));
  return kinds;
}

// Power of the shaft = power on the body + at least that of the induced flow, in all quadrants.
TEST(Propeller, NeverExceedsTheIdealEfficiency) {
  test::Arbitrary arbitrary(531);
  for (const Propeller& propeller : allPropellers())
    for (int i = 0; i < 2000; ++i) {
      const double turns = arbitrary.between(-20, 20), advance = arbitrary.between(-8, 8);
      const PropellerLoad load = propeller.load(turns, advance, kSeaDensity);
      const double through = advance + load.induced;
      const double size = std::abs(load.thrust) * (std::abs(advance) + std::abs(load.induced));
      ASSERT_GE(load.power, load.thrust * through - 1e-12 * size);
      ASSERT_GE(load.power, load.thrust * advance - 1e-12 * size);
      ASSERT_NEAR(load.power, 2 * kPi * turns * load.torque, 1e-12 * std::abs(load.power));
    }
}

TEST(Propeller, ChangesContinuouslyThroughAllQuadrants) {
  for (const Propeller& propeller : allPropellers()) {
    const auto at = [&](double angle) {
      return propeller.load(10 * std::cos(angle), 6 * std::sin(angle), kSeaDensity);
    };
    const double scale = kSeaDensity * 36 * 0.0625;
    const double most = 2e-3;
    for (int i = 0; i < 5000; ++i) {
      const double angle = 2 * kPi * i / 5000;
      const PropellerLoad a = at(angle), b = at(angle + 2 * kPi / 5000);
      ASSERT_NEAR(a.thrust, b.thrust, 3 * most * scale) << angle;
      ASSERT_NEAR(a.torque, b.torque, most * scale * 0.25) << angle;
    }
  }
}

// Blades that stand still brake as plates, and want to turn as a screw in a nut, eq. (165).
TEST(Propeller, BrakesWhereItStandsStill) {
  const Propeller screw = Propeller::wageningen(0.4, b455());
  const double slope = 1 / (0.7 * kPi), disc = kPi / 4 * 0.16;
  const double drag = 0.5 * kSeaDensity * 4 * disc * 0.55 * 1.17 / std::sqrt(1 + slope * slope);
  for (const double advance : {2.0, -2.0}) {
    const PropellerLoad load = screw.load(0, advance, kSeaDensity);
    EXPECT_NEAR(load.thrust, advance > 0 ? -drag : drag, 1e-12 * drag);
    EXPECT_NEAR(load.torque, load.thrust * 0.4 / (2 * kPi), 1e-12 * drag);
    EXPECT_EQ(load.power, 0);
  }
  EXPECT_EQ(screw.load(0, 0, kSeaDensity).thrust, 0);
  // The flow turns it ahead where its shaft is slow: it then gives power.
  EXPECT_LT(screw.load(1, 2, kSeaDensity).power, 0);
  // It stops a ship that still moves ahead, and needs power for it.
  EXPECT_LT(screw.load(-3, 1, kSeaDensity).thrust, 0);
  EXPECT_GT(screw.load(-3, 1, kSeaDensity).power, 0);
}

// Eq. (170): v_i at the disc, 2 v_i and half of the area far behind it at rest; the jet keeps its
// flow, and its momentum is the thrust.
TEST(Propeller, HasAWashThatContracts) {
  const PropellerLoad load = Propeller::idealDisc(0.4).load(50, 0, kSeaDensity);
  const double area = kPi / 4 * 0.16;
  const Wash at = washOf(load.induced, 0, 0.2, 1e-9), far = washOf(load.induced, 0, 0.2, 1e6);
  EXPECT_NEAR(at.velocity, load.induced, 1e-6);
  EXPECT_NEAR(at.radius, 0.2, 1e-6);
  // Far behind it spreads and keeps its momentum, 12.4 radii of its core from the disc on.
  const double core = 0.2 / std::sqrt(2), spread = 1e6 / (12.4 * core);
  EXPECT_NEAR(far.velocity, 2 * load.induced / spread, 1e-9 * far.velocity);
  EXPECT_NEAR(far.radius, core * spread, 1e-9 * far.radius);
  const Wash near = washOf(load.induced, 0, 0.2, 12 * core);
  EXPECT_NEAR(near.velocity, load.induced * (1 + 12 / std::sqrt(146)), 1e-12);
  EXPECT_NEAR(kSeaDensity * kPi * far.radius * far.radius * far.velocity * far.velocity, 50, 1e-7);
  const Wash moving = washOf(load.induced, 3, 0.2, 0.3);
  EXPECT_NEAR(kPi * moving.radius * moving.radius * (3 + moving.velocity),
              area * (3 + load.induced), 1e-12);
  // Backwards the jet goes the other way; there is none before the disc, and none against a stream
  // that comes through it from behind.
  EXPECT_NEAR(washOf(-load.induced, -3, 0.2, 0.3).velocity, moving.velocity, 1e-12);
  EXPECT_EQ(washOf(load.induced, 0, 0.2, -0.1).radius, 0);
  EXPECT_EQ(washOf(load.induced, -2 * load.induced, 0.2, 0.3).radius, 0);
}

// Two blades of chord c with the drag c_d of their sections alone: H = rho c c_d sum over the
// angles of the integral of (w r + V sin a)^2 sin a, against which Q is that of V = 0.
TEST(Propeller, HasTheDragOfItsBladesAcrossItsAxis) {
  constexpr double kChord = 0.02, kDrag = 0.02, kRadius = 0.2, kTurns = 30, kAcross = 3;
  const double turning = 2 * kPi * kTurns;
  constexpr int kSteps = 400;
  double force = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double sine = std::sin(2 * kPi * (i + 0.5) / kSteps);
      const double along = turning * kRadius * (j + 0.5) / kSteps + kAcross * sine;
      force += kSeaDensity * kChord * kDrag * along * std::abs(along) * sine * kRadius /
               (kSteps * kSteps);
    }
  const double torque = kSeaDensity * kChord * kDrag * turning * turning * std::pow(kRadius, 4) / 4;
  const double k_Q = torque / (kSeaDensity * kTurns * kTurns * std::pow(2 * kRadius, 5));
  const Propeller blades = Propeller::byTable(2 * kRadius, {{0, 0, k_Q}, {1, 0, k_Q}});
  const PropellerLoad load = blades.load(kTurns, 0, kSeaDensity);
  const double drag = blades.dragAcross(load, kTurns, 0, kAcross);
  EXPECT_NEAR(drag * kAcross / force, 1, 0.01);
  EXPECT_EQ(blades.dragAcross(load, -kTurns, 0, kAcross), drag);
  EXPECT_EQ(blades.dragAcross({}, 0, 0, 0), 0);
  EXPECT_EQ(Propeller::idealDisc(0.4).dragAcross({50, 0, 100, 1}, 30, 0, 1), 0);
}

TEST(Propeller, HasAJetWithAnEdge) {
  const Wash wash{1, 0.5};
  EXPECT_EQ(wash.shareAt(0), 1);
  EXPECT_NEAR(wash.shareAt(0.4), 1, 1e-15);
  EXPECT_NEAR(wash.shareAt(0.5), 0.5, 1e-15);
  EXPECT_NEAR(wash.shareAt(0.55), 0.25, 1e-15);
  EXPECT_EQ(wash.shareAt(0.61), 0);
}

TEST(Propeller, WashesTheShareOfALineInItsJet) {
  const Wash wash{1, 0.5};
  const auto share = [&](double y, double z, double half) {
    return wash.shareOf({0, y, z}, {0, half, 0});
  };
  EXPECT_NEAR(share(0, 0, 0.4), 1, 1e-15);
  EXPECT_NEAR(share(0, 0, 1), 0.5, 1e-15);
  EXPECT_NEAR(share(0.5, 0, 0.5), 0.5, 1e-15);
  EXPECT_NEAR(share(0, 0.3, 1), 0.4, 1e-15);
  EXPECT_EQ(share(0, 0.6, 1), 0);
  EXPECT_EQ(share(3, 0, 1), 0);
  EXPECT_EQ(share(0.1, 0, 0), 1);
  EXPECT_EQ(share(0.6, 0, 0), 0);
}

TEST(Propeller, RefusesWhatNoPropellerHas) {
  const auto table = [](std::vector<PropellerPoint> points) {
    return test::refusalOf<std::invalid_argument>(
        [&] { Propeller::byTable(0.3, std::move(points)); });
  };
  EXPECT_EQ(table({{0, 1, 1}}), "its table has 1 points; must be at least 2");
  EXPECT_EQ(table({{0.1, 1, 1}, {1, 0, 1}}), "its table begins at J 0.1; must begin at 0, at rest");
  EXPECT_EQ(table({{0, 0.1, 1}, {0, 0, 1}}), "its table has J 0 after 0; must be above that");
  EXPECT_EQ(table({{0, 0.1, 1}, {1, NAN, 1}}), "a number of its table is not finite");
  // K_T^1.5 sqrt(2/pi) / (2 pi) = 0.00401.
  EXPECT_EQ(table({{0, 0.1, 0.004}, {1, 0, 1}}),
            "its table has at J 0 the torque K_Q 0.004 (C_P 0.0251327); must be at least "
            "0.00401569, that of an ideal disc with this thrust");
  EXPECT_EQ(test::refusalOf<std::invalid_argument>([] { Propeller::idealDisc(0); }),
            "its diameter is 0 m; must be above 0");
  EXPECT_EQ(test::refusalOf<std::invalid_argument>([] {
              Propeller::wageningen(1, {4, 0.55, 1.5});
            }),
            "its pitch_ratio is 1.5; must be from 0.5 to 1.4");
}

}  // namespace
}  // namespace ambient
