#include "tests/preprocess/potential_flow/study/image_flow/surface_table.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/inertia.h"
#include "tests/reference/ellipsoid_added_mass.h"

namespace ambient::study {
namespace {

const SurfaceCase& caseNamed(const std::string& name) {
  static const std::vector<SurfaceCase> cases = surfaceCases();
  for (const SurfaceCase& one : cases)
    if (one.shape.find(name) != std::string::npos) return one;
  throw std::logic_error(name);
}

TEST(SurfaceTable, TheErrorIsThatOfTheWorstMotionAboutAnyOrigin) {
  Matrix6 reference = Matrix6::Identity(), inertia = reference;
  inertia(1, 1) = 1.05;
  inertia(4, 4) = 0.9;
  EXPECT_NEAR(largestError(inertia, reference), 0.1, 1e-14);
  const Vector3 away(3, -1, 2);
  EXPECT_NEAR(largestError(shiftOrigin(inertia, away), shiftOrigin(reference, away)), 0.1, 1e-12);
}

// An ellipsoid half in the water, long axis upright. Wet part and image make the whole ellipsoid:
// along the axis and in turns about the others the water has half of its added mass.
TEST(SurfaceTable, TheReferenceIsInTheFrameOfTheBody) {
  const SurfaceCase& body = caseNamed("ellipsoid");
  const Matrix6 water =
      imageInertia(body, {Vector3::UnitX(), 0, 1, 1}, 350) - body.model.above.inertia;
  const Vector6 deep = reference::ellipsoidAddedMass({1.25, 1, 0.75});
  for (const int k : {1, 2, 3}) EXPECT_NEAR(water(k, k) / (deep[k] / 2), 1, 0.01);
  EXPECT_LT(water(4, 4), 0.4 * deep[4]) << "across, the image moves the other way";
  const double mass = 0.5 * body.model.shape->volume;
  EXPECT_NEAR(body.model.above.inertia(3, 3), mass, 1e-12 * mass);
}

TEST(SurfaceTable, HalfOfTheBodyIsInTheWater) {
  const SurfaceModel& hull = caseNamed("hull").model;
  const Vector3 normal = Vector3(0.2, -0.5, 0.7).normalized();
  const SurfacePlane plane{normal, floatingHeight(hull, normal), 1, 1};
  EXPECT_NEAR(immersionOf(hull, plane).wet.volume / hull.shape->volume, 0.5, 1e-9);
}

// Measured errors, as in docs/water.md for these shapes.
TEST(SurfaceTable, BodiesAfloatAreWithinWhatIsStated) {
  const auto errorOf = [](const std::string& name, const Vector3& direction) {
    const SurfaceCase& body = caseNamed(name);
    const Vector3 normal = direction.normalized();
    const SurfacePlane plane{normal, floatingHeight(body.model, normal), 1, 1};
    const Matrix6 inertia = inertiaAt(body.model, immersionOf(body.model, plane));
    return largestError(inertia, imageInertia(body, plane, 350));
  };
  for (const Vector3& normal : {Vector3(0, 0, 1), Vector3(1, 2, 3), Vector3(-1, 1, 1)}) {
    EXPECT_LT(errorOf("sphere", normal), 0.01);
    EXPECT_LT(errorOf("cube", normal), 0.12);
    EXPECT_LT(errorOf("cylinder", normal), 0.07);
    EXPECT_LT(errorOf("ellipsoid", normal), 0.075);
  }
}

}  // namespace
}  // namespace ambient::study
