// Wings, fins and rudders by their numbers, docs/theory.md section 22.

#include "bullet_ambient/force/loads/foils.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/runs.h"

namespace ambient {
namespace {

constexpr double kWater = 998;

Foil plainFoil(double aspect = 3) {
  Foil foil;
  foil.span = aspect;
  foil.chord = 1;
  foil.drag = 0;
  return foil;
}

Twist alongChord(double incidence, double speed = 1) {
  return {Vector3::Zero(), speed * Vector3(std::cos(incidence), 0, -std::sin(incidence))};
}

/// Force over rho/2 v^2 b c.
Vector3 coefficientsOf(const Foil& foil, const Twist& x) {
  const Foils foils({foil});
  return foils.load(x, 1, nullptr).force / (0.5 * x.linear.squaredNorm() * foil.span * foil.chord);
}

// The law of wings on faces in single precision: rounding as of WingLoads.
TEST(Foils, HaveTheLawOfWings) {
  for (const double aspect : {1.0, 3.0, 6.0})
    for (const double degrees : {2.0, 5.0, 10.0, 20.0, 45.0, 90.0}) {
      const double i = degrees * kPi / 180;
      const Vector3 force = coefficientsOf(plainFoil(aspect), alongChord(i));
      EXPECT_NEAR(force.z(), test::normalForceOfPlate(aspect, i), 2e-5) << aspect << " " << degrees;
      EXPECT_NEAR(coefficientsOf(plainFoil(aspect), alongChord(-i)).z(), -force.z(), 2e-5);
    }
  // A fin on a wall has the slope of twice its span.
  Foil fin = plainFoil(2);
  fin.aspect = 4;
  EXPECT_NEAR(coefficientsOf(fin, alongChord(0.05)).z(), test::normalForceOfPlate(4, 0.05), 2e-5);
}

// Munk's moment, which its added mass would have in K, and what stall leaves of it: (49a), (169).
TEST(Foils, LiftAtAQuarterOfTheirChord) {
  for (const double incidence : {0.01, -0.01}) {
    const Wrench load = Foils({plainFoil(6)}).load(alongChord(incidence), kWater, nullptr);
    EXPECT_NEAR(-load.torque.y() / load.force.z(), 0.25, 0.02);
  }
  const Wrench broadside = Foils({plainFoil(6)}).load(alongChord(kPi / 2), kWater, nullptr);
  EXPECT_NEAR(broadside.torque.y() / broadside.force.z(), 0, 1e-6);
}

// Thin aerofoils: C_L = 2 zeta K at no incidence with C_L^2/(pi L) induced, none at -2 zeta.
TEST(Foils, LiftByTheirCamber) {
  Foil foil = plainFoil(6);
  foil.camber = 0.04;
  const double slope = 2 * kPi * 6 / (2 + std::sqrt(40.0)), lift = 2 * 0.04 * slope;
  const Vector3 level = coefficientsOf(foil, alongChord(0));
  EXPECT_NEAR(level.z(), lift, 1e-12);
  EXPECT_NEAR(level.x(), -lift * lift / (kPi * 6), 1e-12);
  // There the vortices of the edges are left, pi sin^2 and what they induce.
  const double without = coefficientsOf(foil, alongChord(-0.08)).z();
  EXPECT_LT(without, 0);
  EXPECT_GT(without, -1.3 * kPi * 0.08 * 0.08);
  foil.camber = -0.04;
  EXPECT_NEAR(coefficientsOf(foil, alongChord(0)).z(), -lift, 1e-12);
  // Broadside no flow is attached.
  EXPECT_NEAR(coefficientsOf(foil, alongChord(kPi / 2)).z(), test::normalForceOfPlate(6, kPi / 2),
              2e-5);
}

// Round noses keep 0.9 of their suction at small incidence, eq. (161b); backwards and thin foils
// none.
TEST(Foils, KeepTheSuctionOfRoundNoses) {
  Foil thin = plainFoil(6), thick = plainFoil(6);
  thick.thickness = 0.08;
  const double slope = 2 * kPi * 6 / (2 + std::sqrt(40.0)), i = 0.03;
  const double kept = 0.9 * slope * (1 - slope / (kPi * 6)) * i * i;
  EXPECT_NEAR(coefficientsOf(thick, alongChord(i)).x(), kept, 0.03 * kept);
  EXPECT_NEAR(coefficientsOf(thick, alongChord(i)).z(), slope * i, 0.01 * slope * i);
  for (const Vector3& none :
       {coefficientsOf(thin, alongChord(i)), coefficientsOf(thick, alongChord(kPi - i))})
    EXPECT_NEAR(none.x(), 0, 1e-12);
  for (const double speed : {0.0, 1e-170, 1e-150})
    EXPECT_TRUE(Foils({thick}).load(alongChord(i, speed), 1, nullptr).force.allFinite()) << speed;
  // They stall later.
  EXPECT_GT(coefficientsOf(thick, alongChord(0.28)).z(),
            1.1 * coefficientsOf(thin, alongChord(0.28)).z());
}

TEST(Foils, HaveTheDragOfTheirProfile) {
  Foil foil = plainFoil();
  foil.drag = 0.02;
  const Wrench load = Foils({foil}).load(alongChord(0, 3), kWater, nullptr);
  EXPECT_NEAR(load.force.x(), -0.5 * kWater * 9 * 3 * 0.02, 1e-9);
}

std::vector<FoilPoint> somePolar() {
  return {{0, 0, 0.01}, {0.2, 1.1, 0.02}, {0.4, 0.7, 0.2}, {kPi / 2, 0, 1.8}, {kPi, 0, 0.02}};
}

TEST(Foils, HaveTheirOwnPolar) {
  Foil foil = plainFoil();
  foil.polar = somePolar();
  const auto expect = [&](double incidence, double lift, double drag) {
    const Vector3 force = coefficientsOf(foil, alongChord(incidence));
    const double c = std::cos(incidence), s = std::sin(incidence);
    EXPECT_NEAR(force.x(), -drag * c + lift * s, 1e-12);
    EXPECT_NEAR(force.z(), drag * s + lift * c, 1e-12);
  };
  for (const FoilPoint& point : somePolar()) {
    expect(point.incidence, point.lift, point.drag);
    expect(-point.incidence, -point.lift, point.drag);
  }
  expect(0.3, 0.9, 0.11);
  foil.polar = {{-kPi, 0, 0.1}, {0, 0.3, 0.01}, {kPi, 0, 0.1}};
  expect(0, 0.3, 0.01);
  expect(-kPi / 2, 0.15, 0.055);
}

std::vector<Foil> allFoils(test::Arbitrary& arbitrary) {
  std::vector<Foil> foils;
  for (int i = 0; i < 5; ++i) {
    Foil foil = plainFoil(arbitrary.between(0.4, 8));
    foil.position = arbitrary.vector();
    foil.chord_axis = arbitrary.vector();
    foil.span_axis = arbitrary.vector();
    foil.thickness = i % 2 == 0 ? 0 : 0.15;
    foil.camber = i == 2 ? 0.05 : 0;
    foil.drag = i * 0.01;
    if (i == 4) foil.polar = somePolar();
    foils.push_back(foil);
  }
  return foils;
}

TEST(Foils, NeverFeedEnergy) {
  test::Arbitrary arbitrary(541);
  PoolSides sides;
  sides.count = 1;
  for (unsigned run = 0; run < test::runsOf(60); ++run) {
    Foils foils(allFoils(arbitrary));
    for (std::size_t i = 0; i < foils.size(); ++i) foils.turn(i, arbitrary.between(-2, 2));
    for (int n = 0; n < 50; ++n) {
      const Twist x = arbitrary.twist(arbitrary.between(0, 3), arbitrary.between(0, 3));
      sides.of[0] = {arbitrary.vector().normalized(), arbitrary.vector()};
      WetPart wet{{arbitrary.vector().normalized(), arbitrary.between(-1, 1), kWater, 9.81}, 0.5};
      if (n % 3 == 0) wet.plane.sides_F = &sides;
      for (std::size_t i = 0; i < foils.size(); ++i)
        for (const WetPart* part : {static_cast<const WetPart*>(nullptr), &std::as_const(wet)}) {
          const Wrench f = foils.load(i, x, kWater, part);
          const double size = f.torque.norm() * x.angular.norm() + f.force.norm() * x.linear.norm();
          ASSERT_LT(power(f, x), 1e-14 * size + 1e-300) << i;
        }
    }
  }
}

// A turn about the span is that of its chord; all loads turn with body, plane and sides.
TEST(Foils, TurnAboutTheirSpan) {
  test::Arbitrary arbitrary(542);
  for (Foil foil : allFoils(arbitrary)) {
    const Twist x = arbitrary.twist(1, 2);
    Foils turned({foil});
    turned.turn(0, 0.3);
    EXPECT_EQ(turned.angle(0), 0.3);
    const Vector3 span = foil.chord_axis.cross(foil.span_axis).cross(foil.chord_axis).normalized();
    const Matrix3 turn = Eigen::AngleAxisd(0.3, span).toRotationMatrix();
    foil.chord_axis = turn * foil.chord_axis;
    foil.span_axis = span;
    const Wrench expected = Foils({foil}).load(x, kWater, nullptr);
    const Wrench load = turned.load(x, kWater, nullptr);
    EXPECT_LE((load.vector() - expected.vector()).norm(), 1e-5 * expected.vector().norm());
  }
}

TEST(Foils, AreWetByTheirStations) {
  test::Arbitrary arbitrary(543);
  Foil foil = plainFoil(4);
  foil.polar = somePolar();
  const Twist x = alongChord(0.2);
  const Wrench whole = Foils({foil}).load(x, kWater, nullptr);
  // A surface across the span through the middle of the foil, and of one half of it. The station
  // is not the middle of its half: 0.155 b/4 aside, 0.039 of the whole.
  for (const auto& [height, share] : {std::pair{0.0, 0.5}, {1.0, 0.75}, {5.0, 1.0}, {-5.0, 0.0}}) {
    const WetPart wet{{Vector3::UnitY(), height, kWater, 9.81}, share};
    EXPECT_NEAR(Foils({foil}).load(x, kWater, &wet).force.z(), share * whole.force.z(),
                0.04 * whole.force.z());
  }
  foil.polar.clear();
  const WetPart dry{{Vector3::UnitY(), -5, kWater, 9.81}, 0};
  EXPECT_TRUE(Foils({foil}).load(x, kWater, &dry).vector().isZero(0));
  PoolSides sides, turned_sides;
  for (const Foil& any : allFoils(arbitrary)) {
    const Matrix3 turn = arbitrary.rotation();
    Foil other = any;
    other.position = turn * any.position;
    other.chord_axis = turn * any.chord_axis;
    other.span_axis = turn * any.span_axis;
    sides.count = turned_sides.count = 1;
    sides.of[0] = {arbitrary.vector().normalized(), any.position};
    turned_sides.of[0] = {turn * sides.of[0].normal, other.position};
    WetPart wet{{arbitrary.vector().normalized(), 0.1, kWater, 9.81, &sides}, 0.5};
    const Twist y = arbitrary.twist(1, 2);
    const Wrench load = Foils({any}).load(y, kWater, &wet);
    wet.plane.normal = turn * wet.plane.normal;
    wet.plane.sides_F = &turned_sides;
    const Wrench same = Foils({other}).load({turn * y.angular, turn * y.linear}, kWater, &wet);
    EXPECT_LE((turn * load.force - same.force).norm(), 1e-5 * load.force.norm());
    EXPECT_LE((turn * load.torque - same.torque).norm(), 1e-5 * load.torque.norm());
  }
}

TEST(Foils, AddToTheLoadsOfABody) {
  Foil foil = plainFoil(2);
  foil.position = {1, 0.5, -0.2};
  FlowSettings flow;
  auto ball = std::make_shared<FluidBody>();
  ball->sphere_radius = 0.4;
  ball->volume = 4 * kPi / 3 * 0.064;
  ball->area = 4 * kPi * 0.16;
  ball->centre_of_volume = {0.3, -0.2, 0.1};
  const auto hull = std::make_shared<FluidBody>(test::smoothHull({4, 1, 0.3}, 2));
  const Twist x{{0.1, 0.4, -0.3}, {1, 0.2, -0.3}};
  for (const auto& body :
       {std::shared_ptr<const FluidBody>(ball), std::shared_ptr<const FluidBody>(hull)}) {
    flow.foils = nullptr;
    const auto plain = makeSurfaceLoads(body, water(), flow);
    flow.foils = std::make_shared<Foils>(std::vector<Foil>{foil});
    const auto both = makeSurfaceLoads(body, water(), flow);
    const FrameOffset frame = plain->frame({});
    const Vector6 expected = frame.toB(plain->load(frame.toF(x))).vector() +
                             flow.foils->load(x, water().density, nullptr).vector();
    const FrameOffset of_both = both->frame({});
    const Vector6 load = of_both.toB(both->load(of_both.toF(x))).vector();
    EXPECT_LE((load - expected).norm(), 1e-12 * expected.norm());
    const SplitLoad split = both->split(of_both.toF(x), nullptr);
    Wrench sum = split.wrench;
    if (both->resistance()) sum += both->resistance()->load(split.growth, of_both.toF(x));
    EXPECT_LE((of_both.toB(sum).vector() - expected).norm(), 1e-12 * expected.norm());
    EXPECT_NE(makeSurfaceLoads(body, water(), flow), both);
    EXPECT_EQ(makeSurfaceLoads(body, Medium{}, flow), nullptr);
  }
}

TEST(Foils, RefuseWhatNoFoilHas) {
  const auto complaint = [](const auto& change) {
    Foil foil = plainFoil();
    change(foil);
    return test::refusalOf<std::invalid_argument>([&] { Foils({plainFoil(), foil}); });
  };
  EXPECT_EQ(complaint([](Foil& f) { f.span = 0; }), "foil 1: its span is 0 m; must be above 0");
  EXPECT_EQ(complaint([](Foil& f) { f.thickness = 0.4; }),
            "foil 1: its thickness is 0.4; must be from 0 to 0.3");
  EXPECT_EQ(complaint([](Foil& f) { f.camber = 0.3; }),
            "foil 1: its camber is 0.3; must be from -0.2 to 0.2");
  EXPECT_EQ(complaint([](Foil& f) { f.span_axis = f.chord_axis; }),
            "foil 1: its chord_axis and span_axis are along one line");
  EXPECT_EQ(complaint([](Foil& f) {
              f.polar = {{0, 0, 0}, {1, 0, 0}};
            }),
            "foil 1: its polar is from 0 to 1 rad; must be from -pi, or from 0, to pi");
  EXPECT_EQ(complaint([](Foil& f) {
              f.polar = {{0, 0, 0}, {kPi, 0, -1}};
            }),
            "foil 1: its polar has the drag -1; must be >= 0");
  Foils foils({plainFoil()});
  EXPECT_EQ(test::refusalOf<std::invalid_argument>(
                [&] { foils.turn(0, std::numeric_limits<double>::infinity()); }),
            "foil 0: its angle is not finite");
}

}  // namespace
}  // namespace ambient
