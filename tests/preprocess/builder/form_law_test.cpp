// Closed forms of the form law, docs/theory.md section 11, on bodies made by the
// preprocessor.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/polar/polar.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

constexpr double kBroadside = 1.17;  // c

/// Drag coefficient of a rectangle broadside by aspect ratio; infinite: 1.98.
double broadsideOf(double aspect) {
  const double x = aspect + 1 / aspect - 2;
  return kBroadside + (1.98 - kBroadside) * x / (x + 40);
}
const Medium kUnitFluid{1, 0, Vector3::Zero(), Vector3::Zero()};

FluidBody bodyOf(const TriangleMesh& mesh, const Vector3& added_mass = {1, 1, 1},
                 bool sheet = false) {
  BuildSettings settings;
  settings.name = "test";
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.sheet = sheet;
  Matrix6 inertia = Matrix6::Zero();
  inertia.bottomRightCorner<3, 3>().diagonal() = added_mass;
  settings.added_mass = inertia;
  return makeFluidBody(mesh, settings);
}

FlowSettings formLaw() {
  FlowSettings flow;
  flow.law = PressureLaw::kForm;
  flow.precision = LoadPrecision::kDouble;
  flow.skin_friction = false;
  return flow;
}

Wrench loadOn(const FluidBody& body, const Twist& x, const FlowSettings& flow = formLaw()) {
  return makeSurfaceLoads(std::make_shared<FluidBody>(body), kUnitFluid, flow)->load(x);
}

Wrench loadInTranslation(const FluidBody& body, const Vector3& velocity) {
  return loadOn(body, {Vector3::Zero(), velocity});
}

/// Drag coefficient C_D on the frontal area `area`.
double dragCoefficient(const FluidBody& body, const Vector3& velocity, double area) {
  return -loadInTranslation(body, velocity).force.dot(velocity.normalized()) /
         (0.5 * velocity.squaredNorm() * area);
}

FluidBody cube(double edge = 1) { return bodyOf(makeBoxMesh(Vector3::Constant(edge / 2), 1200)); }

FluidBody disc(int faces = 2000) {
  return bodyOf(makeEllipticSheetMesh(1, 1, faces), {0, 0, 8.0 / 3}, true);
}

TEST(FormLaw, GivesFlatFacesThatMeetTheFlowTheDragOfAPlate) {
  EXPECT_NEAR(dragCoefficient(cube(), {0, 0, 2}, 1), kBroadside, 1e-12);
  EXPECT_NEAR(dragCoefficient(cube(), {-3, 0, 0}, 1), kBroadside, 1e-12);
  const FluidBody plate = bodyOf(makeRectangularSheetMesh(1, 1, 300), {0, 0, 1}, true);
  EXPECT_NEAR(dragCoefficient(plate, {0, 0, 1}, 1), kBroadside, 1e-12);
  const FluidBody cylinder = bodyOf(makeCylinderMesh(1, 2, 4000));
  EXPECT_NEAR(dragCoefficient(cylinder, {0, 0, 1}, kPi), kBroadside, 2e-3);
}

TEST(FormLaw, GivesLongFlatSidesMore) {
  for (const double aspect : {4.0, 20.0, 50.0, 1000.0}) {
    const FluidBody plate = bodyOf(makeRectangularSheetMesh(1, aspect, 300), {0, 0, 1}, true);
    EXPECT_NEAR(dragCoefficient(plate, {0, 0, 1}, aspect), broadsideOf(aspect), 1e-6) << aspect;
  }
  const FluidBody rod = bodyOf(makeBoxMesh({0.5, 0.5, 10}, 1200));
  EXPECT_NEAR(dragCoefficient(rod, {1, 0, 0}, 20), broadsideOf(20), 1e-6);
  EXPECT_NEAR(dragCoefficient(rod, {0, 0, 1}, 1), kBroadside, 1e-6);
  // Eiffel 1911, plates of 225 cm2, from docs/reality.md.
  EXPECT_NEAR(broadsideOf(20), 1.42, 0.03);
  EXPECT_NEAR(broadsideOf(50), 1.55, 0.08);
}

TEST(FormLaw, GivesACubeEdgeOnItsClosedForm) {
  const double drag = dragCoefficient(cube(), {1, 0, 1}, std::sqrt(2.0));
  EXPECT_NEAR(drag, kBroadside * (std::sqrt(2.0) - 0.5), 1e-12);
}

TEST(FormLaw, PressesAPlateAtIncidenceAtItsCentroid) {
  const FluidBody plate = bodyOf(makeRectangularSheetMesh(2, 0.5, 300), {0, 0, 0}, true);
  for (const double degrees : {1.0, 10.0, 30.0, 45.0, 80.0}) {
    const double i = degrees * kPi / 180;
    const Vector3 v(std::cos(i), 0, std::sin(i));
    const Wrench load = loadInTranslation(plate, v);
    const double normal = broadsideOf(4) * (2 * std::sin(i) - std::sin(i) * std::sin(i));
    EXPECT_NEAR(load.force.z(), -0.5 * normal, 1e-7) << degrees;
    EXPECT_NEAR(load.force.x(), 0, 1e-12);
    EXPECT_NEAR(load.torque.norm(), 0, 1e-12);
  }
}

/// Pressure on the triangles themselves, without Gauss points or levels.
Wrench pressureOnTriangles(const FluidBody& body, const Twist& x) {
  return computeFaceLoads(body.faces, 1, x, {1, 0, 0, false, PressureLaw::kForm}).pressure;
}

TEST(FormLaw, BrakesAPlateThatTurnsAboutItsMiddleLine) {
  const double length = 0.8, span = 2.5, spin = 1.7;
  const FluidBody plate = bodyOf(makeRectangularSheetMesh(length, span, 10000), {0, 0, 0}, true);
  const Twist x{{0, spin, 0}, Vector3::Zero()};
  const double expected = -kBroadside * span * spin * spin * std::pow(length, 4) / 64;
  EXPECT_NEAR(pressureOnTriangles(plate, x).torque.y() / expected, 1, 2e-3);
  const Wrench load = loadOn(plate, x);
  const double gain = broadsideOf(span / length) / kBroadside;
  EXPECT_NEAR(load.torque.y() / expected, 0.99104 * gain, 1e-5);  // Gauss's 4 points on |x|^3
  EXPECT_NEAR(load.force.norm(), 0, 1e-12);
}

TEST(FormLaw, BrakesACubeThatSpins) {
  const Twist x{{0, 0, 1}, Vector3::Zero()};
  EXPECT_NEAR(pressureOnTriangles(bodyOf(makeBoxMesh({0.5, 0.5, 0.5}, 60000)), x).torque.z(),
              -0.08633, 5e-5);
  EXPECT_NEAR(loadOn(cube(), x).torque.z(), -0.08633, 4e-4);
}

TEST(FormLaw, KeepsTheDragOfARoundBody) {
  // Mesh of a sphere with sphere_radius 0.
  const FluidBody coarse = bodyOf(makeEllipsoidMesh({1, 1, 1}, 320));
  const FluidBody fine = bodyOf(makeEllipsoidMesh({1, 1, 1}, 5120));
  const double coarse_drag = dragCoefficient(coarse, {0.6, 0, 0.8}, kPi);
  const double fine_drag = dragCoefficient(fine, {0.6, 0, 0.8}, kPi);
  EXPECT_NEAR(coarse_drag, 0.5, 0.01);
  EXPECT_NEAR(fine_drag, 0.5, 0.001);
  EXPECT_GT(std::abs(coarse_drag - 0.5), 8 * std::abs(fine_drag - 0.5));  // second order
}

TEST(FormLaw, LiftsASpinningRoundBody) {
  const FluidBody ball = bodyOf(makeEllipsoidMesh({1, 1, 1}, 5120));
  const double spin = 0.3;
  const Wrench load = loadOn(ball, {{0, 0, spin}, {1, 0, 0}});
  EXPECT_NEAR(load.force.y() / (0.5 * kPi), 4.0 / 3 * spin, 2e-3);  // along w x v
  EXPECT_NEAR(load.force.x() / (0.5 * kPi), -0.5, 2e-3);            // without S^2
  EXPECT_NEAR(load.torque.norm(), 0, 2e-3);
}

TEST(FormLaw, FollowsTheCurvatureAcrossACylinder) {
  for (const double ratio : {1.0, 5.0, 20.0}) {  // height over diameter
    const double height = 2 * ratio;
    const FluidBody cylinder = bodyOf(makeCylinderMesh(1, height, 20000));
    const double x_sq = (1 + height) / 2;  // (kappa L)^2
    const double root = (1 - x_sq) / (1 + x_sq), s = root * root;
    const double expected = kBroadside * ((1 - s) * 2 / 3 / kBroadside + s * (kPi / 2 - 2.0 / 3));
    EXPECT_NEAR(dragCoefficient(cylinder, {1, 0, 0}, 2 * height), expected, 0.01) << ratio;
  }
}

TEST(FormLaw, LiftsAPlateThatTurnsByItsAddedMass) {
  // (46), (47): a disc of radius 1 has B = 8/3 diag(1, 1, 0).
  const Twist turning{{0, 1, 0}, {0, 0, 1}};
  const Wrench load = loadOn(disc(), turning);
  const Wrench still = loadOn(disc(), {{0, 1, 0}, {0, 0, -1}});
  // B w x v = 8/3 (1, 0, 0). Stall removes a share of D v x w = -8/3 (1, 0, 0), even in v.
  EXPECT_NEAR(load.force.x(), -still.force.x(), 1e-9);
  EXPECT_GT(load.force.x(), 0);
}

/// Stall moment on a disc of radius 1 at 30 degrees, unit fluid, about its centre; has stall_lag. A
/// block, as thick as it is wide.
Wrench discAtThirty(double spin) {
  const Twist x{{0, spin, 0}, {std::cos(kPi / 6), 0, std::sin(kPi / 6)}};
  FluidBody body = disc(20000);
  body.volume = 8.0 / 3;
  FluidBody faces_alone = body;
  faces_alone.added_mass.setZero();
  makeSurfaceForm(body);
  makeSurfaceForm(faces_alone);
  return loadOn(body, x) + -1.0 * loadOn(faces_alone, x);
}

TEST(FormLaw, TakesTheSeparatedShareOfMunksMoment) {
  // Moments about y. Kirchhoff's equations contain Munk's moment of K x; loads contain its loss.
  const double munk = 8.0 / 3 * std::cos(kPi / 6) * std::sin(kPi / 6);
  EXPECT_NEAR(munk, 1.15470, 1e-5);
  const double lost = std::abs(discAtThirty(0).torque.y());
  EXPECT_NEAR(munk - lost, 0.40864, 2e-3);
  EXPECT_NEAR(discAtThirty(0).force.norm(), 0, 1e-12);
  EXPECT_NEAR(discAtThirty(-1).torque.y(), -1.15163, 2e-3);
  EXPECT_NEAR(munk - std::abs(discAtThirty(1).torque.y()), 0.99698 * munk, 2e-3);
}

TEST(FormLaw, LeavesAWingOfMunksMomentWhatPutsTheLiftAtAQuarterOfTheChord) {
  // (47a) and (49a) of a disc of radius 1: L = 1, c_w = sqrt(3), l = 8 (8/3)/(pi 2 pi).
  const double slope = 2 * kPi / (2 + std::sqrt(5.0));
  const double length = 8 * (8.0 / 3) / (2 * kPi * kPi);
  const double f_0 = slope * std::sqrt(3.0) / (2 * kPi * length);
  EXPECT_NEAR(f_0, 0.378, 1e-3);
  const FluidBody wing = disc(20000);
  for (const double degrees : {1.0, 10.0, 30.0, 60.0}) {
    const double i = degrees * kPi / 180, sine = std::sin(i), cosine = std::cos(i);
    const Twist x{Vector3::Zero(), {cosine, 0, sine}};
    const double r = sine * sine / 0.5;
    const double lost = 1 - f_0 / (1 + r * r);
    EXPECT_NEAR(loadOn(wing, x).torque.y(), -lost * 8.0 / 3 * sine * cosine, 1e-3) << degrees;
  }
}

TEST(FormLaw, HasNoStallWhereTheAddedMassHasNoDirection) {
  const Twist x{{0.3, -0.2, 0.9}, {0.5, 1, -0.3}};
  FlowSettings other = formLaw();
  other.stall_lag = 0;
  EXPECT_EQ(loadOn(cube(), x).vector(), loadOn(cube(), x, other).vector());
  EXPECT_NE(loadOn(disc(), x).vector(), loadOn(disc(), x, other).vector());
}

TEST(FormLaw, IsContinuousWhereAFaceTurnsItsBack) {
  for (const double tilt : {1e-3, 1e-6}) {
    const Vector3 v(tilt, 0, 1);
    const Vector3 side = loadInTranslation(cube(), v).force;
    EXPECT_LT(std::abs(side.x()), 2 * tilt);
  }
}

TEST(MeasuredDrag, IsWhatABodyThenHas) {
  FluidBody body = bodyOf(makeBoxMesh({1, 0.3, 0.5}, 400));
  body.drag = {0.8, 1.4, 1.05};
  const Vector3 areas(4 * 0.3 * 0.5, 4 * 0.5, 4 * 0.3);
  for (int axis = 0; axis < 3; ++axis)
    for (const double way : {2.0, -2.0})
      EXPECT_NEAR(dragCoefficient(body, way * Vector3::Unit(axis), areas[axis]), body.drag[axis],
                  1e-12);
}

TEST(MeasuredDrag, LeavesLiftAndItsMoment) {
  const FluidBody foil = bodyOf(makeBoxMesh({1, 3, 0.03}, 12), {0.01, 0.01, 1});
  FluidBody measured = foil;
  measured.drag = {0.02, 0.02, 1.2};
  for (const double degrees : {2.0, 8.0, 40.0}) {
    const double angle = degrees * kPi / 180;
    const Vector3 v(std::cos(angle), 0, -std::sin(angle)), up(std::sin(angle), 0, std::cos(angle));
    const Wrench before = loadInTranslation(foil, v), after = loadInTranslation(measured, v);
    EXPECT_GT(before.force.dot(up), 0);
    EXPECT_NEAR(after.force.dot(up), before.force.dot(up), 1e-12);
    EXPECT_LT((after.torque - before.torque).norm(), 1e-12);
    EXPECT_GT(std::abs(after.force.dot(v) / before.force.dot(v) - 1), 0.01) << degrees;
  }
}

TEST(MeasuredDrag, IsOnTheSilhouette) {
  // The second box is behind the first along x and overlaps it by a half along z.
  TriangleMesh mesh = makeBoxMesh({0.1, 0.5, 0.5}, 12);
  TriangleMesh other = mesh;
  other.vertices.colwise() += Eigen::Vector3d(1, 0, 0.5);
  FluidBody body = bodyOf(joinMeshes({mesh, other}));
  const double tolerance = 1e-3;
  EXPECT_NEAR(frontalArea(body, {1, 0, 0}), 1.5, tolerance);
  EXPECT_NEAR(frontalArea(body, {0, 1, 0}), 0.4, tolerance);
  EXPECT_NEAR(frontalArea(body, {0, 0, 1}), 0.4, tolerance);
  EXPECT_NEAR(frontalArea(body, Vector3(1, 1, 0).normalized()),
              // Each 0.6 sqrt(2) wide; shifted by sqrt(1/2) to the side and 0.5 along z.
              2 * 1.2 * std::sqrt(0.5) - 0.5 * (1.2 - 1) * std::sqrt(0.5), tolerance);
  setMeasuredDrag({1.1, 0.9, 1.3}, body);
  EXPECT_NEAR(dragCoefficient(body, {1, 0, 0}, 1.5), 1.1, 1e-3);
  EXPECT_NEAR(dragCoefficient(body, {0, 0, 1}, 0.4), 1.3, 1e-3);
}

TEST(MeasuredDrag, TakesEnergyInEveryMotion) {
  FluidBody body = bodyOf(makeConeMesh(1, 2, 400));
  body.drag = {0.2, 3, 0.5};
  test::Arbitrary arbitrary(9);
  const auto loads = makeSurfaceLoads(std::make_shared<FluidBody>(body), kUnitFluid, formLaw());
  for (int i = 0; i < 10000; ++i) {
    const Twist x = arbitrary.twist();
    EXPECT_LT(power(loads->load(x), x), 0);
    const Twist twice{2 * x.angular, 2 * x.linear};  // degree 2
    EXPECT_LE((loads->load(twice).vector() - 4 * loads->load(x).vector()).norm(),
              1e-12 * loads->load(twice).vector().norm());
  }
}

TEST(MeasuredDrag, IsRefusedIfNotPositive) {
  FluidBody body = cube();
  body.drag = {1, 0, 1};
  EXPECT_THROW(checkFluidBody(body, "cube"), std::runtime_error);
  body.drag = {1, -1, 1};
  EXPECT_THROW(checkFluidBody(body, "cube"), std::runtime_error);
  body.drag = {1, 2, 1};
  EXPECT_EQ(decodeFluidBody(encodeFluidBody(body, "cube"), "cube").drag, body.drag);
}

TEST(FormLawFaces, OfABoxAreGaussPoints) {
  const FluidBody box = bodyOf(makeBoxMesh({0.5, 0.25, 0.125}, 1200));
  const FaceTable faces = formLawFaces(box, {});
  EXPECT_EQ(faces.size(), 6 * 16u);
  double area = 0;
  Vector3 closed = Vector3::Zero();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const double aspect = std::abs(faces.normal_y[i]) > 0.5 ? 4 : 2;
    EXPECT_NEAR(faces.sharpness[i], broadsideOf(aspect) / kBroadside, 1e-7);
    area += faces.area[i];
    closed += faces.area[i] * faces.normal(i);
  }
  EXPECT_NEAR(area, box.area, 1e-14);
  EXPECT_NEAR(closed.norm(), 0, 1e-14);
}

TEST(FormLawFaces, OfASphereAreItsTriangles) {
  const FluidBody ball = bodyOf(makeEllipsoidMesh({1, 1, 1}, 320));
  EXPECT_EQ(formLawFaces(ball, {}).size(), ball.faces.size());
}

TEST(FormLawFaces, AreTheSameForFilesWithoutSharpness) {
  FluidBody old = bodyOf(makeConeMesh(1, 2, 400));
  const FaceTable now = formLawFaces(old, {});
  old.faces.sharpness.clear();
  EXPECT_EQ(formLawFaces(old, {}).sharpness, now.sharpness);
}

TEST(FormLawFaces, DoBetterThanTwiceAsManyTriangles) {
  // Wrench on a box in random motions against the one on very fine triangles.
  const auto boxOf = [](int faces) { return bodyOf(makeBoxMesh({0.5, 0.25, 0.125}, faces)); };
  const FluidBody fine = boxOf(60000), coarse = boxOf(400);
  FaceTable points = formLawFaces(fine, {});
  points.sharpness.assign(points.size(), 1);
  EXPECT_GE(coarse.faces.size(), 2 * points.size());
  test::Arbitrary arbitrary(3);
  const auto direction = [&] { return arbitrary.vector().normalized(); };
  const auto pressureOn = [](const FaceTable& faces, const Twist& x) {
    const LoadSettings settings{1, 0, 0, false, PressureLaw::kForm};
    return computeFaceLoads(faces, 1, x, settings).pressure.vector();
  };
  double worst_points = 0, worst_triangles = 0;
  for (int i = 0; i < 300; ++i) {
    const double share = i / 300.0 * kPi / 2;
    const Twist x{std::sin(share) / 0.5 * direction(), std::cos(share) * direction()};
    const Vector6 exact = pressureOn(fine.faces, x);
    const double scale = 0.5 * fine.area;
    worst_points = std::max(worst_points, (pressureOn(points, x) - exact).norm() / scale);
    worst_triangles =
        std::max(worst_triangles, (pressureOn(coarse.faces, x) - exact).norm() / scale);
  }
  EXPECT_LT(worst_points, 0.0033);
  EXPECT_LT(worst_points, worst_triangles);
}

}  // namespace
}  // namespace ambient
