#include "preprocess/potential_flow/results/added_mass_parts.h"

#include <gtest/gtest.h>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

Matrix6 sumOfParts(const std::vector<AddedMassPart>& parts) {
  Matrix6 sum = Matrix6::Zero();
  for (const AddedMassPart& part : parts) sum += part.inertia;
  return sum;
}

double largestEntry(const Matrix6& K) { return K.cwiseAbs().maxCoeff(); }

TEST(AddedMassParts, SumUpToTheAddedMassAboutAnyOrigin) {
  // Energy gives the translation, the potential gives the parts: they differ by the discretisation,
  // 2 % here.
  const TriangleMesh box = moved(makeBoxMesh({0.5, 0.4, 0.3}, 600), {0.1, 0.7, -0.4});
  const PotentialFlow flow = solvePotentialFlow(box);
  EXPECT_LT(largestEntry(sumOfParts(flow.parts) - flow.added_mass),
            0.025 * largestEntry(flow.added_mass));
  EXPECT_LE(flow.parts.size(), 96u);
  EXPECT_GE(flow.parts.size(), 90u);
}

TEST(AddedMassParts, OfASheetSumUpToRounding) {
  PotentialFlowSettings settings;
  settings.sheet = true;
  const PotentialFlow flow =
      solvePotentialFlow(moved(makeRectangularSheetMesh(1, 0.5, 300), {0.1, 0.2, 0.3}), settings);
  EXPECT_LT(largestEntry(sumOfParts(flow.parts) - flow.added_mass),
            1e-6 * largestEntry(flow.added_mass));
}

TEST(AddedMassParts, OfAnEllipsoidFollowFromItsClosedForm) {
  const Eigen::Vector3d axes(1, 0.7, 0.4);
  const auto parts = joinPanels(ellipsoidPanels(makeEllipsoidMesh(axes, 1280), axes));
  const Matrix6 K = ellipsoidAddedMass(axes).asDiagonal();
  EXPECT_LT(largestEntry(sumOfParts(parts) - K), 0.01 * largestEntry(K));
  EXPECT_EQ(parts.size(), 96u);
}

TEST(AddedMassParts, KnowWhereTheyAre) {
  // Panels at one place make one part: a mean weighted by area.
  PanelInertia a, b;
  a.normal = b.normal = Vector3(0, 0, 1);
  a.centroid = b.centroid = Vector3(1, 2, 0);
  a.area = 3;
  b.area = 1;
  a.spread[0] = 1;
  b.spread[0] = 5;
  const auto parts = joinPanels({a, b});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].centre, Vector3(1, 2, 0));
  EXPECT_EQ(parts[0].spread[0], 2);
  const auto there = placed(parts, 2, {0, 0, 3});
  EXPECT_EQ(there[0].centre, Vector3(2, 4, 3));
  EXPECT_EQ(there[0].spread[0], 8);
}

TEST(AddedMassParts, AreRoundedToTheSinglePrecisionOfFiles) {
  const auto isSingle = [](double value) {
    volatile float single = static_cast<float>(value);
    return static_cast<double>(single) == value;
  };
  const auto parts =
      joinPanels(ellipsoidPanels(makeEllipsoidMesh({1, 0.7, 0.4}, 320), {1, 0.7, 0.4}));
  for (const AddedMassPart& part : placed(parts, 0.3, {0.1, 0.2, 0.3})) {
    for (const double value : part.centre) EXPECT_TRUE(isSingle(value)) << value;
    for (const double value : part.spread) EXPECT_TRUE(isSingle(value)) << value;
    for (const double value : part.inertia.reshaped()) EXPECT_TRUE(isSingle(value)) << value;
  }
}

TEST(AddedMassParts, OfABoxDoNotReachAroundItsEdges) {
  const Vector3 half(0.5, 0.4, 0.3);
  for (const AddedMassPart& part : solvePotentialFlow(makeBoxMesh(half, 600)).parts) {
    const double off = ((part.centre.cwiseAbs() - half).cwiseAbs()).minCoeff();
    EXPECT_LT(off, 1e-6);                                // within a side
    EXPECT_LT(part.spread.head<3>().minCoeff(), 1e-12);  // flat
  }
}

TEST(AddedMassParts, MoveWithTheirOrigin) {
  const TriangleMesh box = makeBoxMesh({0.5, 0.4, 0.3}, 300);
  const Eigen::Vector3d by(0.3, -0.2, 0.5);
  const auto here = solvePotentialFlow(box).parts;
  const auto there = solvePotentialFlow(moved(box, by)).parts;
  EXPECT_LT(largestEntry(shiftOrigin(sumOfParts(here), -by) - sumOfParts(there)), 1e-6);
}

}  // namespace
}  // namespace ambient
