#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/added_mass_parts.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using test::addedMassOf;
using test::differenceOf;
using test::skewBody;

double lowestEigenvalue(const Matrix6& K) {
  const auto values = symmetricEigen<6>(K).values;
  return values[0] / values[5];
}

TEST(AddedMass, IsSymmetricPositiveSemiDefiniteForAllBodies) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.05);
  std::vector<TriangleMesh> meshes = {
      makeBoxMesh({1, 1, 1}, 12),           makeBoxMesh({1, 0.5, 1e-3}, 300),
      makeBoxMesh({1, 1e-2, 1e-2}, 300),    makeEllipsoidMesh({1, 1, 1}, 80),
      makeEllipsoidMesh({1, 1, 0.01}, 320), makeCylinderMesh(1, 1, 300),
      makeCylinderMesh(1, 0.002, 300),      makeConeMesh(0.2, 2, 300),
      test::gradedTetrahedron(2),           test::makeTorus({2, 0.2, 8, 24})};
  for (int i = 0; i < 10; ++i) {
    TriangleMesh rough = makeEllipsoidMesh({1, 0.7, 0.4}, 180);
    for (Eigen::Index k = 0; k < rough.vertices.size(); ++k)
      rough.vertices.data()[k] += normal(random);
    meshes.push_back(rough);
  }
  for (const TriangleMesh& mesh : meshes) {
    const PotentialFlow flow = solvePotentialFlow(mesh);
    EXPECT_EQ(flow.added_mass, flow.added_mass.transpose());
    // Tolerance: rounding of eigenvalues.
    EXPECT_GE(lowestEigenvalue(flow.added_mass), -1e-15);
    EXPECT_LE(flow.removed_eigenvalue, 0);
    EXPECT_GE(flow.removed_eigenvalue, -1e-3);
    EXPECT_LT(flow.asymmetry, 0.05);
  }
}

TEST(AddedMass, NegativeEigenvaluesAreRemovedAndReported) {
  // A plate of 12 triangles, aspect 1000: edgewise inertia is below the resolution.
  const PotentialFlow flow = solvePotentialFlow(makeBoxMesh({1, 1, 1e-3}, 12));
  EXPECT_LT(flow.removed_eigenvalue, -1e-6);
  EXPECT_GT(flow.removed_eigenvalue, -1e-3);
  EXPECT_NEAR(lowestEigenvalue(flow.added_mass), 0, 1e-15);
  EXPECT_GT(flow.added_mass(5, 5), 1);
}

TEST(AddedMass, SatisfiesReciprocityBeforeSymmetrisingUpToDiscretisation) {
  // A body without symmetry: no entry agrees by accident. The asymmetry falls with refinement.
  const double coarse = solvePotentialFlow(skewBody(makeBoxMesh({0.5, 0.35, 0.6}, 300))).asymmetry;
  const double fine = solvePotentialFlow(skewBody(makeBoxMesh({0.5, 0.35, 0.6}, 1200))).asymmetry;
  // Measured 1.2e-3 and 7.6e-5.
  EXPECT_GT(coarse, 1e-6);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, 0.25 * coarse);
}

TEST(AddedMass, OfTwoSpheresNearbyHasTheFirstOrderOfTheirInteraction) {
  // Dipole interaction (Lamb, art. 138), R^3 from the facetted spheres' volume. Along the line of
  // centres K = 2 (2/3 pi R^3) (1 - 3 R^3 / c^3 + ...); across the factor is 1 + 3/2 R^3 / c^3 +
  // ....
  const TriangleMesh sphere = makeEllipsoidMesh({1, 1, 1}, 320);
  const double c = 6, one = addedMassOf(sphere)(3, 3);
  const double ratio = one / (2.0 / 3.0 * kPi) / (c * c * c);
  const Matrix6 pair =
      addedMassOf(joined(moved(sphere, {c / 2, 0, 0}), moved(sphere, {-c / 2, 0, 0})));
  EXPECT_NEAR(pair(3, 3) / (2 * one) - 1, -3 * ratio, 0.03 * ratio);
  EXPECT_NEAR(pair(4, 4) / (2 * one) - 1, 1.5 * ratio, 0.03 * ratio);
}

TEST(AddedMass, OfAHollowBodyIncludesTheFluidInside) {
  // Fluid in a cavity translates with the walls: K holds its mass and first moments.
  const TriangleMesh outside = makeEllipsoidMesh({1, 0.8, 0.6}, 500);
  const Vector3d centre(0.2, 0.1, 0);
  const TriangleMesh cavity = moved(makeEllipsoidMesh({0.4, 0.3, 0.3}, 180), centre);
  const Matrix6 filled = addedMassOf(joined(outside, insideOut(cavity))) - addedMassOf(outside);
  const double volume = test::volumeOf(cavity);
  const Matrix3 mass = filled.bottomRightCorner<3, 3>(), coupling = filled.topRightCorner<3, 3>();
  // Hat functions contain linear potentials: quadrature error only; measured 1.4e-9, 4e-6.
  EXPECT_LT((mass - volume * Matrix3::Identity()).norm(), 1e-7 * volume);
  EXPECT_LT((coupling - volume * crossMatrix(centre)).norm(), 1e-5 * volume);
}

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

// Where a ring of parts has none opposite, as on a capsule, planes through the axis are left.
TEST(AddedMassParts, OfSimpleShapesAreMirroredWithinRounding) {
  const Matrix6 K = Vector6(0.3, 0.3, 0.3, 0.5, 0.5, 0.5).asDiagonal();
  const std::pair<TriangleMesh, int> shapes[] = {{makeBoxMesh({1, 0.7, 0.4}, 350), 7},
                                                 {makeCylinderMesh(0.7, 0.8, 500), 7},
                                                 {makeCapsuleMesh(0.7, 0.8, 500), 3},
                                                 {makeConeMesh(0.7, 0.8, 500), 3},
                                                 {test::gradedTetrahedron(2), 0}};
  for (const auto& [mesh, mirrors] : shapes) {
    const std::vector<AddedMassPart> parts = estimateParts(mesh, K), images = mirrored(parts);
    EXPECT_EQ(AddedMassParts(images).blocks().mirrors, mirrors);
    ASSERT_EQ(images.size(), parts.size());
    for (const AddedMassPart& image : images)
      EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const AddedMassPart& part) {
        return (image.centre - part.centre).norm() < 1e-5 &&
               (image.inertia - part.inertia).norm() < 1e-5 * part.inertia.norm();
      }));
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

}  // namespace
}  // namespace ambient
