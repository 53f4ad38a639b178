#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"

// Shapes whose flow is solved at the default number of panels.
namespace ambient {
namespace {

using test::alongAxis;
using test::rotationError;
using test::translationError;

TEST(SolvedShape, WithoutTablesTheSolverIsWithinItsTolerance) {
  CollisionShapeSettings settings;
  settings.tables = false;
  const FluidBody cylinder = makeFluidBody(btCylinderShapeZ(btVector3(1, 1, 1)), settings);
  const Matrix6 round = alongAxis(reference::cylinderAddedMass(), 2);
  // Measured 3.7e-3 and 4e-4.
  EXPECT_LT(rotationError(cylinder.added_mass, round), 5e-3);
  EXPECT_LT(translationError(cylinder.added_mass, round), 1e-3);
  const FluidBody capsule = makeFluidBody(btCapsuleShapeX(1, 2), settings);
  const Matrix6 smooth = alongAxis(reference::capsuleAddedMass(), 0);
  // Measured 1.0e-4 and 4e-6.
  EXPECT_LT(rotationError(capsule.added_mass, smooth), 5e-4);
  EXPECT_LT(translationError(capsule.added_mass, smooth), 5e-5);
}

TEST(SolvedShape, ThreeEqualSpheresInALineAreACapsule) {
  const btVector3 centres[3] = {btVector3(0, -1, 0), btVector3(0, 0, 0), btVector3(0, 1, 0)};
  const btScalar radii[3] = {1, 1, 1};
  const FluidBody capsule = makeFluidBody(btMultiSphereShape(centres, radii, 3));
  const Matrix6 exact = alongAxis(reference::capsuleAddedMass(), 1);
  EXPECT_NEAR(capsule.volume / (10 * kPi / 3), 1, 1e-4);  // extrapolated
  // Measured 4e-5 and 1.4e-4.
  EXPECT_LT(rotationError(capsule.added_mass, exact), 1e-3);
  EXPECT_LT(translationError(capsule.added_mass, exact), 5e-4);
}

}  // namespace
}  // namespace ambient
