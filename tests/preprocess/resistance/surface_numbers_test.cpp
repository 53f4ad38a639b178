#include "preprocess/resistance/surface_numbers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/resistance/separation.h"

namespace ambient {
namespace {

const Matrix3 kAxes = Matrix3::Identity();

TEST(SurfaceNumbers, OfABallAreKnown) {
  const double r = 0.7;
  const SurfaceNumbers ball =
      computeSurfaceNumbers(makeEllipsoidMesh({r, r, r}, 20480), false, {}, kAxes);
  EXPECT_NEAR(ball.diameter / (2 * r), 1, 1e-3);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(ball.frontal[j] / (kPi * r * r), 1, 1e-3) << j;
    EXPECT_NEAR(ball.moments[j] / (r * r / 3), 1, 1e-3) << j;
    EXPECT_NEAR(ball.gyration(j, j) / (2 * r * r / 3), 1, 1e-3) << j;
  }
}

TEST(SurfaceNumbers, OfABoxAreExact) {
  const Vector3 h(0.5, 1, 2);
  const SurfaceNumbers box = computeSurfaceNumbers(makeBoxMesh(h, 300), false, {}, kAxes);
  const double area = 8 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
  EXPECT_NEAR(box.diameter, std::sqrt(area / kPi), 1e-12);
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    const double ends = 8 * h[k] * h[l], sides = area - ends;
    EXPECT_NEAR(box.frontal[j], ends / 2, 1e-12) << j;
    EXPECT_NEAR(box.moments[j], (ends + sides / 3) * h[j] * h[j] / area, 1e-12) << j;
  }
}

TEST(SurfaceNumbers, OfACylinderAreThoseOfTheFormula) {
  const double r = 0.5, L = 3, side = 2 * kPi * r * L, ends = 2 * kPi * r * r, area = side + ends;
  const SurfaceNumbers cylinder =
      computeSurfaceNumbers(makeCylinderMesh(r, L, 20000), false, {}, kAxes);
  EXPECT_NEAR(cylinder.moments.z() / ((L * L / 12 * side + L * L / 4 * ends) / area), 1, 3e-3);
  EXPECT_NEAR(cylinder.moments.x() / ((r * r / 2 * side + r * r / 4 * ends) / area), 1, 3e-3);
}

TEST(SurfaceNumbers, CountBothSidesOfASheet) {
  const SurfaceNumbers plate =
      computeSurfaceNumbers(makeRectangularSheetMesh(1, 2, 100), true, {}, kAxes);
  EXPECT_NEAR(plate.diameter, std::sqrt(4 / kPi), 1e-12);
  EXPECT_NEAR(plate.frontal.z(), 2, 1e-12);
  EXPECT_NEAR(plate.frontal.x(), 0, 1e-12);
}

TEST(SurfaceNumbers, TakeGyrationAboutTheCentreOfReaction) {
  const Vector3 centre(0.1, -0.2, 0.3);
  const TriangleMesh mesh = makeBoxMesh({0.5, 1, 2}, 300);
  const SurfaceNumbers near = computeSurfaceNumbers(mesh, false, {}, kAxes);
  const SurfaceNumbers beside = computeSurfaceNumbers(mesh, false, {{0, 0, 0}, centre}, kAxes);
  const Matrix3 change = centre.squaredNorm() * Matrix3::Identity() - centre * centre.transpose();
  EXPECT_LT((beside.gyration - near.gyration - change).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(beside.moments, near.moments);
}

TEST(SharpShare, IsOneOfEdgesAndPlates) {
  FormShape shape;
  shape.edges = 0;
  EXPECT_EQ(sharpShare(shape), 0);
  shape.edges = 0.45;
  EXPECT_NEAR(sharpShare(shape), 0.5, 1e-15);
  shape.wing = 0.5;
  EXPECT_NEAR(sharpShare(shape), 0.75, 1e-15);
  shape.edges = 1;
  EXPECT_EQ(sharpShare(shape), 1);
}

TEST(RefinedFlow, HasThePotentialsThatLayersNeed) {
  PotentialFlowSettings settings;
  settings.max_panels = 1000;
  const TriangleMesh mesh = makeEllipsoidMesh({2, 1, 1}, 1280);
  const RefinedFlow flow = solveRefinedFlow(mesh, settings);
  const Separation separation = computeSeparation(flow.surface, flow.potential.rightCols<3>(),
                                                  translationAxes(flow.added_mass))
                                    .separation;
  EXPECT_NEAR(separation.ways[0].wake_laminar / 0.9245, 1, 0.04);
  const RefinedFlow box = solveRefinedFlow(makeBoxMesh({0.5, 1, 2}, {1, 1, 1}), settings);
  const Separation edged =
      computeSeparation(box.surface, box.potential.rightCols<3>(), translationAxes(box.added_mass))
          .separation;
  EXPECT_LT(edged.smooth_base.maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace ambient
