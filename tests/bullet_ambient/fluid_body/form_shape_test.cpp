// Numbers of a shape for the form law, docs/theory.md eq. (45a) to (45d).

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/wing_bodies.h"

namespace ambient {
namespace {

TEST(FormShape, OfASheetIsAWingAsSharpAsItsBorder) {
  const FormShape shape = formShapeOf(test::rectangularWing(3));
  EXPECT_EQ(shape.wing, 1);
  EXPECT_EQ(shape.edges, 1);
  EXPECT_FALSE(shape.isSlender());
  EXPECT_NEAR(std::abs(shape.facing.z()), 1, 1e-14);
  EXPECT_NEAR(std::abs(shape.span.y()), 1, 1e-14);
  EXPECT_NEAR(shape.chord, 1, 0.01);
  EXPECT_NEAR(shape.aspect, 3, 0.03);
  EXPECT_NEAR(shape.pitching.norm(), std::sqrt(0.4 * (1 - 1.0 / 9)), 0.002);
}

TEST(FormShape, OfABodyAsThickAsWideIsABlock) {
  FluidBody body = test::bodyOfFaces(test::faceTableOf(test::geodesicSphere(2)));
  body.volume = 4 * kPi / 3;
  body.added_mass.bottomRightCorner<3, 3>() = Matrix3::Identity() * body.volume / 2;
  const FormShape shape = formShapeOf(body);
  EXPECT_EQ(shape.wing, 0);
  EXPECT_FALSE(shape.isWing());
}

TEST(FormShape, OfASmoothSlenderBodyHasItsLongAxis) {
  const FluidBody body = test::smoothHull({4, 1, 1});
  const FormShape shape = formShapeOf(body);
  EXPECT_EQ(shape.wing, 0);
  EXPECT_LT(shape.edges, 1e-12);
  EXPECT_NEAR(std::abs(shape.slender.normalized().x()), 1, 1e-12);
  // m^2 = (k2 - k1)/k2, eq. (45d)
  EXPECT_NEAR(shape.slender.squaredNorm(), (0.86 - 0.08) / 0.86, 1e-12);
}

TEST(FormShape, IsThatOfABlockWithoutAddedMassOrFaces) {
  FluidBody body = test::rectangularWing(2);
  body.added_mass.setZero();
  EXPECT_FALSE(formShapeOf(body).isWing());
  EXPECT_FALSE(formShapeOf(FluidBody{}).isWing());
  body = test::bodyOfFaces({});
  body.faces.add(Vector3::UnitZ(), Vector3::Zero(), 1);  // a single face has no chord
  EXPECT_FALSE(formShapeOf(body).isWing());
}

TEST(FormShape, DoesNotDependOnSizeAndTurnsWithTheBody) {
  const FluidBody wing = test::rectangularWing(3);
  const FormShape shape = formShapeOf(wing), large = formShapeOf(scaled(wing, 8));
  EXPECT_EQ(shape.wing, large.wing);
  EXPECT_EQ(shape.aspect, large.aspect);
  EXPECT_EQ(8 * shape.chord, large.chord);
  EXPECT_EQ(shape.span, large.span);
}

TEST(FormShape, ChangesWithThicknessWithoutAJump) {
  // V/k3 is the ratio of thickness to width: W falls from 1 to 0 as it grows to 1.
  double before = 1;
  for (double thickness = 0; thickness <= 1.2; thickness += 0.05) {
    FluidBody wing = test::rectangularWing(2);
    wing.volume = thickness * wing.added_mass(5, 5);
    const double now = formShapeOf(wing).wing;
    EXPECT_LE(now, before);
    EXPECT_GT(now, before - 0.2);
    EXPECT_NEAR(now, std::pow(std::max(1 - thickness * thickness, 0.0), 2), 1e-12);
    before = now;
  }
  EXPECT_EQ(before, 0);
}

}  // namespace
}  // namespace ambient
