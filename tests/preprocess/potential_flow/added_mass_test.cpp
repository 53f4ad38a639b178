#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/shapes/primitives.h"
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

TEST(AddedMass, OfTwoSpheresFarApartIsTheirSum) {
  const TriangleMesh sphere = makeEllipsoidMesh({1, 1, 1}, 320);
  const TriangleMesh small = scaled(sphere, 0.5);
  const Vector3d here(-100, 0, 0), there(150, 40, -30);
  const Matrix6 pair = addedMassOf(joined(moved(sphere, here), moved(small, there)));
  const Matrix6 sum = addedMassOf(moved(sphere, here)) + addedMassOf(moved(small, there));
  // Interaction of the dipoles: a multiple of (R / distance)^3 = 6e-8.
  EXPECT_LT(Matrix3((pair - sum).bottomRightCorner<3, 3>()).norm(), 1e-6);
  // Rotation about a distant origin is a translation, integrated by (11) instead of (10):
  // quadratures differ by 1e-5.
  EXPECT_LT(differenceOf(pair, sum, 150), 2e-5);
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

}  // namespace
}  // namespace ambient
