#include "preprocess/potential_flow/results/flow_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/reference/body_added_mass.h"

namespace ambient {
namespace {

PotentialFlowSettings panelSettings(int panels, bool sheet = false) {
  PotentialFlowSettings settings;
  settings.max_panels = panels;
  settings.sheet = sheet;
  return settings;
}

TEST(FlowEstimate, OfADividedMeshIsAboveItsError) {
  const TriangleMesh cube = makeBoxMesh({1, 1, 1}, 12);
  const auto estimate = estimateFlow(cube, panelSettings(1000));
  ASSERT_TRUE(estimate);
  EXPECT_LT(estimate->other_panels, estimate->panels);
  const Matrix6 K = solveRefinedFlow(cube, panelSettings(1000)).added_mass;
  const auto errorOf = [](double value, double truth) { return std::abs(value / truth - 1); };
  // Estimate and error, measured: 1.0e-1 and 1.5e-3, 9.1e-3 and 2.0e-3.
  EXPECT_GT(estimate->rotation_error, errorOf(K(0, 0), reference::cubeRotationalAddedMass()));
  EXPECT_GT(estimate->translation_error,
            errorOf(K(3, 3), 8 * reference::cubeAddedMassCoefficient()));
  EXPECT_LT(estimate->translation_error, 2e-2);
}

TEST(FlowEstimate, OfAFineMeshIsFromMorePanels) {
  const TriangleMesh egg = makeEllipsoidMesh({1, 0.8, 0.6}, 320);
  const auto estimate = estimateFlow(egg, panelSettings(0));
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->panels, 320);
  EXPECT_GT(estimate->other_panels, 960);
  // The error beside many more panels on these facets, over the largest entry of the block.
  const Matrix6 limit = solvePotentialFlow(divideTriangles(egg, 4000), panelSettings(0)).added_mass,
                K = solvePotentialFlow(egg, panelSettings(0)).added_mass;
  const auto block = [](const Matrix6& matrix) {
    return matrix.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff();
  };
  const double error = block(K - limit) / block(limit);
  EXPECT_NEAR(estimate->translation_error, error, 0.3 * error);
}

TEST(FlowEstimate, LargeMeshesHaveNone) {
  EXPECT_FALSE(estimateFlow(makeEllipsoidMesh({1, 1, 1}, 2700), panelSettings(0)));
}

TEST(FlowEstimate, PlaceOfTheMeshDoesNotMatter) {
  const TriangleMesh box = makeBoxMesh({1, 0.5, 0.2}, 12);
  const auto here = estimateFlow(box, panelSettings(600));
  const auto there = estimateFlow(moved(box, {5, 6, 7}), panelSettings(600));
  ASSERT_TRUE(here && there);
  EXPECT_NEAR(there->rotation_error, here->rotation_error, 1e-5);
  EXPECT_NEAR(there->translation_error, here->translation_error, 1e-6);
}

TEST(FlowEstimate, OfASheet) {
  const auto estimate = estimateFlow(makeRectangularSheetMesh(2, 1, 16), panelSettings(800, true));
  ASSERT_TRUE(estimate);
  EXPECT_GT(estimate->translation_error, 0);
}

}  // namespace
}  // namespace ambient
