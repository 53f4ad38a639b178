// Form law on wings and slender hulls, docs/theory.md eq. (43) to (50).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/runs.h"

namespace ambient {
namespace {

FlowSettings formLaw(LoadPrecision precision) {
  FlowSettings flow;
  flow.law = PressureLaw::kForm;
  flow.precision = precision;
  flow.skin_friction = false;
  return flow;
}

std::shared_ptr<const SurfaceLoads> loadsOf(const FluidBody& body,
                                            LoadPrecision precision = LoadPrecision::kDouble,
                                            double separation_angle = kPi / 2) {
  FlowSettings flow = formLaw(precision);
  flow.separation_angle = separation_angle;
  const auto prepared = std::make_shared<FluidBody>(body);
  makeSurfaceForm(*prepared);
  return makeSurfaceLoads(prepared, {1.3, 0, {}, {}}, flow);
}

/// C_N of a sheet at incidence `degrees` in flow along its chord.
double normalForce(const FluidBody& wing, double degrees,
                   LoadPrecision precision = LoadPrecision::kDouble) {
  const double i = degrees * kPi / 180;
  const Twist x{Vector3::Zero(), {std::cos(i), 0, std::sin(i)}};
  return -loadsOf(wing, precision)->load(x).force.z() / (0.5 * 1.3 * wing.area / 2);
}

TEST(WingLoads, HaveTheClosedFormOfAPlateAtIncidence) {
  for (const double aspect : {1.0, 3.0, 6.0})
    for (const double degrees : {2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0}) {
      FluidBody wing = test::rectangularWing(aspect);
      // Aspect ratio of the faces' centres, which the law sees.
      const double seen = formShapeOf(wing).aspect;
      const double expected = test::normalForceOfPlate(seen, degrees * kPi / 180);
      EXPECT_NEAR(normalForce(wing, degrees), expected, 1e-12) << aspect << " " << degrees;
      EXPECT_NEAR(normalForce(wing, degrees, LoadPrecision::kSingle), expected, 2e-5);
    }
}

TEST(WingLoads, AreNearEiffelsPlates) {
  // Eiffel 1911, square plate and 6 : 1; data/reality/measurements.json.
  const FluidBody square = test::rectangularWing(1), slender = test::rectangularWing(6, 12);
  EXPECT_NEAR(normalForce(square, 6), 0.214, 0.03);
  EXPECT_NEAR(normalForce(square, 37), 1.553, 0.05);
  EXPECT_NEAR(normalForce(square, 30), 1.328, 0.1);
  EXPECT_NEAR(normalForce(square, 90), 1.17, 1e-9);
  EXPECT_NEAR(normalForce(slender, 6), 0.438, 0.07);
}

/// Bodies of all kinds: sheets, hulls, bumpy ones with the added mass of a wing and of a block.
FluidBody anyBody(test::Arbitrary& arbitrary, int i) {
  if (i % 4 == 0) return test::rectangularWing(arbitrary.between(0.2, 8), 8);
  if (i % 4 == 1)
    return test::smoothHull({arbitrary.between(1, 8), 1, arbitrary.between(0.2, 1)}, 2);
  FluidBody body = test::bodyOfFaces(arbitrary.body(2));
  body.volume = i % 4 == 2 ? 0 : 0.5;
  body.centre_of_volume = arbitrary.vector(0.3);
  for (std::size_t k = 0; k < body.faces.size(); ++k)
    body.faces.sharpness.push_back(arbitrary.between(0, 1.5));
  body.added_mass.bottomRightCorner<3, 3>() =
      arbitrary.positiveDefinite().bottomRightCorner<3, 3>();
  return body;
}

TEST(WingLoads, NeverFeedEnergy) {
  // 4e4 motions: all shapes, both precisions.
  test::Arbitrary arbitrary(71);
  int wings = 0, hulls = 0;
  for (int shape = 0; shape < 100; ++shape) {
    const FluidBody body = anyBody(arbitrary, shape);
    const FormShape form = formShapeOf(body);
    wings += form.isWing();
    hulls += form.isSlender();
    for (const LoadPrecision precision : {LoadPrecision::kSingle, LoadPrecision::kDouble}) {
      const auto loads = loadsOf(body, precision);
      ASSERT_FALSE(loads->needsGuard());
      for (unsigned i = 0; i < test::runsOf(200); ++i) {
        const Twist x = arbitrary.twist(arbitrary.between(0, 5), arbitrary.between(0, 5));
        const Wrench f = loads->load(x);
        const double size = f.torque.norm() * x.angular.norm() + f.force.norm() * x.linear.norm();
        ASSERT_LT(power(f, x), 1e-15 * size) << shape;
      }
    }
  }
  EXPECT_GE(wings, 40);
  EXPECT_GE(hulls, 20);
}

TEST(WingLoads, AreHomogeneousOfDegreeTwo) {
  test::Arbitrary arbitrary(72);
  for (int shape = 0; shape < 40; ++shape) {
    const auto loads = loadsOf(anyBody(arbitrary, shape));
    const Twist x = arbitrary.twist(2, 2);
    const Vector6 load = loads->load(x).vector();
    for (const double s : {1e-3, 0.3, 7.0}) {
      const Vector6 scaled = loads->load({s * x.angular, s * x.linear}).vector();
      EXPECT_LE((scaled - s * s * load).norm(), 1e-12 * scaled.norm());
    }
  }
}

TEST(WingLoads, TurnWithTheBody) {
  test::Arbitrary arbitrary(73);
  for (int shape = 0; shape < 20; ++shape) {
    const FluidBody body = anyBody(arbitrary, shape);
    const Matrix3 turn = arbitrary.rotation();
    FluidBody turned = body;
    turned.faces = {};
    for (std::size_t i = 0; i < body.faces.size(); ++i)
      turned.faces.add(turn * body.faces.normal(i), turn * body.faces.centroid(i),
                       body.faces.area[i]);
    turned.faces.sharpness = body.faces.sharpness;
    turned.surface = {};
    FluidBody plain = body;
    plain.surface = {};  // sharpness is given, or that of a hull
    if (plain.faces.sharpness.empty())
      plain.faces.sharpness = turned.faces.sharpness = std::vector<double>(plain.faces.size(), 0.2);
    turned.centre_of_volume = turn * body.centre_of_volume;
    turned.added_mass.bottomRightCorner<3, 3>() =
        turn * body.added_mass.bottomRightCorner<3, 3>() * turn.transpose();
    const Twist x = arbitrary.twist(2, 2);
    const Wrench a = loadsOf(plain)->load(x);
    const Wrench b = loadsOf(turned)->load({turn * x.angular, turn * x.linear});
    EXPECT_LE((turn * a.force - b.force).norm(), 1e-9 * b.force.norm()) << shape;
    EXPECT_LE((turn * a.torque - b.torque).norm(), 1e-9 * b.torque.norm()) << shape;
  }
}

/// Largest torque about z, by which motions of a drop with few, uneven faces differ from those of a
/// body of revolution, over the largest of all torques. `is_round`: its moments of inertia are
/// known.
double spinningTorque(bool is_round) {
  FluidBody drop = test::latticeEllipsoid({0.2, 0.2, 0.5}, 7, 6);
  const double across = (0.04 + 0.25) / 5;
  if (is_round) drop.uniform_mass.inertia = Vector3(across, across, 0.08 / 5).asDiagonal();
  const auto loads = loadsOf(drop);
  test::Arbitrary arbitrary(75);
  double spinning = 0, largest = 0;
  for (int i = 0; i < 100; ++i) {
    const Twist x = arbitrary.twist(2, 2);
    const Wrench load = loads->load(x);
    EXPECT_LE(power(load, x), 1e-15);
    spinning = std::max(spinning, std::abs(load.torque.z()));
    largest = std::max(largest, load.torque.norm());
  }
  return spinning / largest;
}

// Eq. (66b).
TEST(WingLoads, DoNotSpinABodyOfRevolution) {
  EXPECT_LT(spinningTorque(true), 1e-14);
  EXPECT_GT(spinningTorque(false), 0.01);
}

TEST(WingLoads, ChangeContinuouslyWithTheMotion) {
  test::Arbitrary arbitrary(74);
  for (int shape = 0; shape < 40; ++shape) {
    const auto loads = loadsOf(anyBody(arbitrary, shape));
    for (int i = 0; i < 50; ++i) {
      const Twist x = arbitrary.twist(2, 2), d = arbitrary.twist(1e-7, 1e-7);
      const Vector6 change = loads->load({x.angular + d.angular, x.linear + d.linear}).vector() -
                             loads->load(x).vector();
      const double scale = loads->load(x).vector().norm() + 1;
      EXPECT_LE(change.norm(), 1e-4 * scale) << shape;
    }
  }
}

TEST(WingLoads, PressAtAQuarterOfTheChordAtSmallIncidence) {
  // Munk's moment and what stall leaves of it put the centre of pressure there, eq. (49a).
  const FluidBody wing = test::rectangularWing(6, 12);
  const double i = 0.01;
  const Vector3 v(std::cos(i), 0, std::sin(i));
  const Wrench load = loadsOf(wing)->load({Vector3::Zero(), v});
  const Vector3 impulse = 1.3 * wing.added_mass.bottomRightCorner<3, 3>() * v;
  const double moment = load.torque.y() + impulse.cross(v).y();  // with Munk's, eq. (4)
  EXPECT_NEAR(moment / load.force.z(), -0.25, 0.02);
}

TEST(WingLoads, AreFiniteAtRestAndWhereAFaceMovesStraightAwayFromTheFluid) {
  // |u| + u_n of eq. (43) is 0 there, on a hull that is a wing and slender.
  FluidBody hull = test::smoothHull({4, 1, 0.3}, 2);
  hull.added_mass.bottomRightCorner<3, 3>() = hull.volume * Vector3(0.05, 0.3, 3).asDiagonal();
  const ShapeFactors factors(formShapeOf(hull));
  ASSERT_TRUE(factors.in_double.is_wing && factors.in_double.is_slender);
  FaceTable faces = hull.faces;
  if (faces.sharpness.empty()) faces.sharpness.assign(faces.size(), 0);
  const LoadSettings settings{1.3, 0, 0, false, PressureLaw::kForm, &factors};
  for (const LoadPrecision precision : {LoadPrecision::kSingle, LoadPrecision::kDouble}) {
    const auto loads = loadsOf(hull, precision);
    EXPECT_TRUE(loads->load({Vector3::Zero(), Vector3::Zero()}).vector().isZero(0));
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (const double speed : {1.0, 1e-170}) {
        const Twist x{Vector3::Zero(), -speed * faces.normal(i)};
        EXPECT_TRUE(loads->load(x).vector().allFinite()) << i;
        EXPECT_TRUE(computeFaceFlow(faces, i, 1, x, settings).pressure.allFinite()) << i;
      }
  }
}

TEST(WingLoads, RefuseALagWhoseProductsWithTheMotionMayNotBeFinite) {
  const auto hull = std::make_shared<FluidBody>(test::smoothHull({4, 1, 0.3}, 2));
  FlowSettings flow = formLaw(LoadPrecision::kDouble);
  flow.stall_lag = 1e6;
  const auto loads = makeSurfaceLoads(hull, {1.3, 0, {}, {}}, flow);
  EXPECT_TRUE(loads->load({Vector3(0, 1e9, 0), Vector3(1e-9, 0, 1e-9)}).vector().allFinite());
  for (const double lag : {-1.0, 1.1e6, 1e308, std::nan("")}) {
    flow.stall_lag = lag;
    EXPECT_THROW(makeSurfaceLoads(hull, {1.3, 0, {}, {}}, flow), std::invalid_argument);
  }
}

TEST(WingLoads, AreTheSumOfTheFlowAtEachFace) {
  test::Arbitrary arbitrary(75);
  for (int shape = 0; shape < 12; ++shape) {
    const FluidBody body = anyBody(arbitrary, shape);
    const ShapeFactors factors(formShapeOf(body));
    FaceTable faces = body.faces;
    if (faces.sharpness.empty()) faces.sharpness.assign(faces.size(), 0.3);
    const Twist x = arbitrary.twist(2, 2);
    for (const double cosine : {0.0, -0.6}) {
      const LoadSettings settings{1.3, 0, cosine, false, PressureLaw::kForm, &factors};
      Vector3 force = Vector3::Zero();
      for (std::size_t i = 0; i < faces.size(); ++i)
        force += computeFaceFlow(faces, i, 1, x, settings).pressure;
      const Wrench sum = computeFaceLoads(faces, 1, x, settings).pressure;
      EXPECT_LE((force - sum.force).norm(), 1e-11 * sum.force.norm());
      const Wrench single = computeFaceLoad(PackedFaces(faces, factors.shape), 1, x, settings);
      EXPECT_LE((single.vector() - sum.vector()).norm(), 1e-5 * sum.vector().norm());
    }
  }
}

}  // namespace
}  // namespace ambient
