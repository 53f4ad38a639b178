#include <gtest/gtest.h>

#include <utility>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/waterline/waterline_builder.h"
#include "tests/preprocess/potential_flow/study/image_flow/surface_cases.h"
#include "tests/reference/body_added_mass.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient::study {
namespace {

TriangleMesh raised(TriangleMesh mesh, double height) {
  mesh.vertices.row(2).array() += height;
  return mesh;
}

// Heave: half of the ball without a surface. Surge: Legendre functions of even degree, as in Storti
// and D'Elia, "Added mass of an oscillating hemisphere at very-low and very-high frequencies",
// 2004. Their sum to degree 400 is 0.27324 of the water's mass, 4/pi - 1 to five digits.
TEST(ImageFlow, AHemisphereHasTheAddedMassOfHighFrequencies) {
  const Matrix6 K = solveImageFlow(ellipsoidMesh({1, 1, 1}, 720), 500);
  const double water = 2 * kPi / 3, surge = (4 / kPi - 1) * water;
  EXPECT_NEAR(K(5, 5) / (water / 2), 1, 1e-3);
  EXPECT_NEAR(K(3, 3) / surge, 1, 0.015) << "measured 0.990";
  EXPECT_NEAR(K(4, 4) / surge, 1, 0.015);
  EXPECT_LT(K.topLeftCorner(3, 3).cwiseAbs().maxCoeff(), 1e-3 * water);
}

TEST(ImageFlow, HeaveRollAndPitchAtTheMiddleAreHalfOfTheDeepBody) {
  const Vector3 semi_axes(1.2, 0.8, 0.6);
  const Matrix6 K = solveImageFlow(ellipsoidMesh(semi_axes, 720), 500);
  const Vector6 deep = reference::ellipsoidAddedMass(semi_axes);
  for (const int k : {0, 1, 5}) EXPECT_NEAR(K(k, k) / (deep[k] / 2), 1, 2e-3);
  const Matrix6 cube = solveImageFlow(makeBoxMesh({1, 1, 1}, 12), 500);
  EXPECT_NEAR(cube(5, 5) / (4 * reference::cubeAddedMassCoefficient()), 1, 0.015);
}

// First reflection of a dipole in the surface; the next term has the sixth power.
TEST(ImageFlow, ASubmergedSphereFeelsItsImage) {
  const double depth = 3, reflection = 3.0 / 16 / (depth * depth * depth), deep = 2 * kPi / 3;
  const Matrix6 K = solveImageFlow(raised(ellipsoidMesh({1, 1, 1}, 500), -depth), 500);
  EXPECT_NEAR(K(5, 5) / deep, 1 - 2 * reflection, 2e-4);
  EXPECT_NEAR(K(3, 3) / deep, 1 - reflection, 2e-4);
}

TEST(ImageFlow, IsThatOfTheWetPart) {
  const TriangleMesh box = raised(makeBoxMesh({1, 0.5, 0.3}, 12), 0.2);
  EXPECT_NEAR(computeSheetMassProperties(wetPartOf(box)).area, 2 + 6 * 0.1, 1e-12);
  const MirroredMesh mirrored = withImage(wetPartOf(box));
  EXPECT_TRUE(requireSound(checkMesh(mirrored.mesh, "box"), "box").warnings.empty());
  EXPECT_NEAR(test::volumeOf(mirrored.mesh), 2 * 2 * 0.1, 1e-12);
  EXPECT_TRUE(solveImageFlow(raised(box, 1), 100).isZero(0));
}

// A deck at the surface, to rounding, is not a wet side.
TEST(ImageFlow, ADeckAwashIsDry) {
  const TriangleMesh box = makeBoxMesh({1, 0.5, 0.3}, 12);
  const Matrix6 awash = solveImageFlow(raised(box, -0.3), 100);
  for (const double above : {-1e-15, 1e-15, 1e-6}) {
    const Matrix6 K = solveImageFlow(raised(box, -0.3 + above), 100);
    EXPECT_LT((K - awash).norm(), 1e-4 * awash.norm()) << above;
  }
}

// An ellipsoid half in the water, long axis upright. Wet part and image make the whole ellipsoid:
// along the axis and in turns about the others the water has half of its added mass.
TEST(ImageFlow, IsInTheFrameOfTheBody) {
  const Vector3 semi_axes(1.25, 1, 0.75);
  const SurfaceCase body = makeSurfaceCase({"ellipsoid", ellipsoidMesh(semi_axes, 500)});
  const Matrix6 water =
      imageInertia(body, {Vector3::UnitX(), 0, 1, 1}, 350) - body.model.above.inertia;
  const Vector6 deep = reference::ellipsoidAddedMass(semi_axes);
  for (const int k : {1, 2, 3}) EXPECT_NEAR(water(k, k) / (deep[k] / 2), 1, 0.01);
  EXPECT_LT(water(4, 4), 0.4 * deep[4]) << "across, the image moves the other way";
  const double mass = 0.5 * body.model.shape->volume;
  EXPECT_NEAR(body.model.above.inertia(3, 3), mass, 1e-12 * mass);
}

// Measured errors by the parts of the added mass, docs/water_validation.md.
TEST(ImageFlow, BodiesAfloatAreWithinWhatIsStated) {
  const std::pair<SurfaceCase, double> bodies[] = {
      {makeSurfaceCase({"sphere", ellipsoidMesh({1, 1, 1}, 500), 1}), 0.01},
      {makeSurfaceCase({"cube", makeBoxMesh({1, 1, 1}, 12)}), 0.12},
      {makeSurfaceCase({"cylinder", makeCylinderMesh(0.5, 2, 300)}), 0.07},
      {makeSurfaceCase({"ellipsoid", ellipsoidMesh({1.25, 1, 0.75}, 500)}), 0.075}};
  for (const auto& [body, bound] : bodies) {
    for (const Vector3& direction : {Vector3(0, 0, 1), Vector3(1, 2, 3), Vector3(-1, 1, 1)}) {
      const Vector3 normal = direction.normalized();
      const SurfacePlane plane{normal, floatingHeight(body.model, normal), 1, 1};
      const Immersion at = immersionOf(body.model, plane);
      EXPECT_NEAR(at.wet.volume / body.model.shape->volume, 0.5, 1e-9);
      EXPECT_LT(largestError(inertiaAt(body.model, at), imageInertia(body, plane, 350)), bound)
          << body.shape << " " << normal.transpose();
    }
  }
}

}  // namespace
}  // namespace ambient::study
