#include "preprocess/hand_over/ellipsoid_fit.h"

#include <gtest/gtest.h>

#include "preprocess/hand_over/ellipsoid_drag.h"
#include "tests/preprocess/hand_over/handed_bodies.h"

namespace ambient::test {
namespace {

double largestError(const Vector3& a, const Vector3& b) {
  return (a - b).cwiseQuotient(b).cwiseAbs().maxCoeff();
}

TEST(EllipsoidFit, FindsTheSemiAxesOfAnEllipsoid) {
  for (const Vector3& semi_axes : {Vector3(1, 1, 1), Vector3(3, 2, 1), Vector3(0.01, 0.02, 0.05),
                                   Vector3(40, 1, 1), Vector3(1, 1, 0.02), Vector3(10, 3, 0.1)}) {
    const auto added = reference::ellipsoidAddedMass(semi_axes);
    EXPECT_LT(largestError(semiAxesOf(added.tail<3>()), semi_axes), 1e-11) << semi_axes.transpose();
  }
}

// Any three added masses are those of an ellipsoid: a cube's, and ones of no real body.
TEST(EllipsoidFit, HasTheAddedMassesThatWereAskedFor) {
  for (const Vector3& added :
       {Vector3(0.638, 0.638, 0.638), Vector3(1, 10, 100), Vector3(7, 7, 1)}) {
    const Vector3 found = reference::ellipsoidAddedMass(semiAxesOf(added)).tail<3>();
    EXPECT_LT(largestError(found, added), 1e-11) << added.transpose();
  }
}

// A disc: 8/3 a^3 along its axis and nothing along its plane.
TEST(EllipsoidFit, OfADiscIsThin) {
  const Vector3 semi_axes = semiAxesOf({0, 0, 8.0 / 3});
  EXPECT_NEAR(semi_axes[0], 1, 2e-3);
  EXPECT_LT(semi_axes[2], 3e-3);
}

TEST(EllipsoidFit, FindsWhereItStands) {
  const PlacedEllipsoid placed;
  const EllipsoidFit fit = fitEllipsoid(bodyOf(placed)->added_mass, {0, 0, 0});
  // The free shift of sheets is held back by a billionth.
  EXPECT_LT((fit.centre - placed.centre).norm(), 1e-8);
  const PlacedEllipsoid found{fit.semi_axes, fit.centre, fit.axes};
  const Matrix6 K = bodyOf(found)->added_mass;
  EXPECT_LT((K - bodyOf(placed)->added_mass).cwiseAbs().maxCoeff(), 1e-8);
}

// A sheet leaves the shift along its normal free.
TEST(EllipsoidFit, StaysInTheMiddleOfASheet) {
  Matrix6 added = Matrix6::Zero();
  added(5, 5) = 8.0 / 3;
  EXPECT_LT((fitEllipsoid(added, {0, 0, 0.3}).centre - Vector3(0, 0, 0.3)).norm(), 1e-12);
}

TEST(EllipsoidDrag, FindsTheCoefficientsOfAnEllipsoid) {
  const Vector3 semi_axes(2, 0.7, 0.4);
  const EllipsoidDrag drag{0.6, 0.1, 1.2};
  const EllipsoidDrag found = fitDrag(unitDrag(drag, semi_axes), semi_axes);
  EXPECT_NEAR(found.blunt, drag.blunt, 1e-12);
  EXPECT_NEAR(found.slender, drag.slender, 1e-12);
  EXPECT_NEAR(found.angular, drag.angular, 1e-12);
}

// MuJoCo's formula, written out: a disc that falls flat, and one that spins.
TEST(EllipsoidDrag, IsMuJoCos) {
  const double pi = portable::acos(-1.0);
  const Vector6 drag = unitDrag({0.5, 0.25, 1.5}, {2, 1, 0.5});
  EXPECT_NEAR(drag[5], 0.5 * pi * 2 * 1, 1e-13);
  EXPECT_NEAR(drag[3], 0.5 * pi * 0.5 + 0.25 * (pi * 2 - pi * 0.5), 1e-13);
  const double largest = 8.0 / 15 * pi * 1 * 16, about_z = 8.0 / 15 * pi * 0.5 * 16;
  EXPECT_NEAR(drag[2], 1.5 * about_z + 0.25 * (largest - about_z), 1e-12);
}

}  // namespace
}  // namespace ambient::test
