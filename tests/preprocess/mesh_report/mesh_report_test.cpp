#include "preprocess/mesh_report/mesh_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/reference/body_added_mass.h"

namespace ambient {
namespace {

MeshReport reportOn(const TriangleMesh& mesh, int panels, bool sheet = false) {
  PotentialFlowSettings settings;
  settings.max_panels = panels;
  settings.sheet = sheet;
  return makeMeshReport(mesh, settings);
}

double errorOf(double value, double truth) { return std::abs(value / truth - 1); }

class CubeReport : public ::testing::Test {
 protected:
  static double rotationErrorOf(const Matrix6& K) {
    return errorOf(K(0, 0), reference::cubeRotationalAddedMass());
  }
  static double translationErrorOf(const Matrix6& K) {
    return errorOf(K(3, 3), 8 * reference::cubeAddedMassCoefficient());
  }

  const TriangleMesh cube_ = makeBoxMesh({1, 1, 1}, 12);
  const MeshReport report_ = reportOn(cube_, 1000);
};

TEST_F(CubeReport, EstimateIsWithinAFactorOfTwo) {
  const Matrix6& K = report_.built.added_mass;
  EXPECT_LT(report_.other->panels, report_.built.panels);
  // Estimate and error, measured: 4.5e-3 and 6.0e-3, 5.9e-2 and 3.8e-2.
  EXPECT_LT(std::abs(std::log2(report_.translation_error / translationErrorOf(K))), 1);
  EXPECT_LT(std::abs(std::log2(report_.rotation_error / rotationErrorOf(K))), 1);
  EXPECT_LT(translationErrorOf(report_.extrapolated), translationErrorOf(K) / 3);
  EXPECT_LT(rotationErrorOf(report_.extrapolated), rotationErrorOf(K) / 1.5);
}

TEST_F(CubeReport, EstimateOfABuildIsAboveItsError) {
  ASSERT_TRUE(report_.build);
  EXPECT_LT(report_.build->coarse_panels, report_.build->panels);
  const Matrix6& K = report_.build->added_mass;
  // Estimate and error, measured: 1.0e-1 and 1.5e-3, 9.1e-3 and 2.0e-3.
  EXPECT_GT(report_.build->rotation_error, rotationErrorOf(K));
  EXPECT_GT(report_.build->translation_error, translationErrorOf(K));
  EXPECT_LT(report_.build->translation_error, 2e-2);
  BuildSettings settings;
  settings.flow.max_panels = 1000;
  EXPECT_LT((makeFluidBody(cube_, settings).added_mass - K).norm(), 1e-12 * K.norm());
}

TEST(MeshReport, ABuildOnTheMeshItselfIsNotEstimated) {
  EXPECT_FALSE(reportOn(makeEllipsoidMesh({1, 0.8, 0.6}, 320), 400).build) << "smooth";
  EXPECT_FALSE(reportOn(makeBoxMesh({1, 1, 1}, 300), 0).build) << "fine";
}

TEST(MeshReport, FineMeshesAreComparedWithMorePanels) {
  const TriangleMesh egg = makeEllipsoidMesh({1, 0.8, 0.6}, 320);
  const MeshReport report = reportOn(egg, 0);
  EXPECT_EQ(report.built.panels, 320);
  ASSERT_TRUE(report.other);
  EXPECT_GT(report.other->panels, 960);
  // Extrapolation must predict the result of many more panels on these facets.
  PotentialFlowSettings settings;
  const Matrix6 limit = solvePotentialFlow(divideTriangles(egg, 4000), settings).added_mass;
  const double error = std::abs(report.built.added_mass(5, 5) / limit(5, 5) - 1);
  EXPECT_LT(std::abs(report.extrapolated(5, 5) / limit(5, 5) - 1), 0.3 * error);
}

TEST(MeshReport, LargeMeshesGetNoEstimate) {
  MeshReport report = reportOn(makeEllipsoidMesh({1, 1, 1}, 2700), 0);
  EXPECT_FALSE(report.other);
  EXPECT_EQ(report.extrapolated, report.built.added_mass);
  EXPECT_EQ(report.rotation_error, 0);
}

TEST(MeshReport, ConditionGrowsWithThinness) {
  const auto conditionOf = [](double thickness) {
    return reportOn(makeBoxMesh({1, 1, thickness}, 12), 600).built.condition;
  };
  EXPECT_GT(conditionOf(0.5), 1);
  EXPECT_GT(conditionOf(0.01), 10 * conditionOf(0.5));
}

TEST(MeshReport, PlaceOfTheMeshDoesNotMatter) {
  const TriangleMesh box = makeBoxMesh({1, 0.5, 0.2}, 12);
  const MeshReport here = reportOn(box, 600);
  const MeshReport there = reportOn(moved(box, {5, 6, 7}), 600);
  EXPECT_LT((there.origin - Eigen::Vector3d(5, 6, 7)).norm(), 1e-12);
  EXPECT_LT((there.built.added_mass - here.built.added_mass).norm(),
            1e-10 * here.built.added_mass.norm());
}

TEST(MeshReport, SheetsHaveNoThickness) {
  const MeshReport report = reportOn(makeRectangularSheetMesh(2, 1, 16), 800, true);
  EXPECT_FALSE(report.thinnest);
  EXPECT_GT(report.translation_error, 0);
}

TEST(ThinnestPart, OfABoxIsItsThickness) {
  const auto box = findThinnestPart(makeBoxMesh({1, 2, 0.05}, 200));
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->thickness, 0.1, 1e-12);
  EXPECT_NEAR(std::abs(box->barycentre.z()), 0.05, 1e-12);
  const auto two = findThinnestPart(
      joined(makeBoxMesh({1, 1, 1}, 12), moved(makeBoxMesh({1, 1, 0.25}, 12), {0, 0, 1.3})));
  EXPECT_NEAR(two->thickness, 0.5, 1e-12) << "the gap of 0.05 is not a part";
}

TEST(WorstTriangles, AreSortedByAspect) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 12);
  mesh.vertices.row(2) *= 0.001;
  const auto worst = findWorstTriangles(mesh, 100);
  ASSERT_EQ(worst.size(), 12u);
  EXPECT_NEAR(worst.front().aspect, 1000, 1);
  EXPECT_NEAR(worst.front().smallest_angle, 0.001, 1e-6);
  EXPECT_NEAR(worst.back().aspect, 2, 1e-12);
  EXPECT_NEAR(worst.back().smallest_angle, std::acos(-1.0) / 4, 1e-12);
  EXPECT_EQ(findWorstTriangles(mesh, 3).size(), 3u);
}

}  // namespace
}  // namespace ambient
