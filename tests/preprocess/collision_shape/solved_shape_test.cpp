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

TEST(SolvedShape, TwoEqualSpheresOfAMultiSphereAreACapsule) {
  const btVector3 centres[2] = {btVector3(0, -1, 0), btVector3(0, 1, 0)};
  const btScalar radii[2] = {1, 1};
  const FluidBody capsule = makeFluidBody(btMultiSphereShape(centres, radii, 2));
  const Matrix6 exact = alongAxis(reference::capsuleAddedMass(), 1);
  EXPECT_NEAR(capsule.volume / (10 * kPi / 3), 1, 1e-4);  // extrapolated
  // Measured 4e-5 and 1.4e-4.
  EXPECT_LT(rotationError(capsule.added_mass, exact), 1e-3);
  EXPECT_LT(translationError(capsule.added_mass, exact), 5e-4);
}

TEST(SolvedShape, RoundedConeIsWithinHalfAPercentOfFinerOnes) {
  btConeShapeZ cone(1, 2);
  cone.setMargin(btScalar(0.1));
  CollisionShapeSettings settings, finer;
  settings.tables = finer.tables = false;
  finer.faces = 1800;
  finer.flow.max_panels = 5000;
  const Matrix6 exact = makeFluidBody(cone, finer).added_mass;
  const Matrix6 K = makeFluidBody(cone, settings).added_mass;
  EXPECT_LT(rotationError(K, exact), 3e-3);
  EXPECT_LT(translationError(K, exact), 2e-3);
  // All meshes have three rows of triangles around the rim: measured 1.4e-2 and 8e-3.
  const Matrix6 tabulated = makeFluidBody(cone).added_mass;
  EXPECT_LT(rotationError(K, tabulated), 2e-2);
  EXPECT_LT(translationError(K, tabulated), 1e-2);
}

}  // namespace
}  // namespace ambient
