#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/study/accuracy_case.h"
#include "tests/preprocess/potential_flow/study/study_meshes.h"
#include "tests/reference/body_added_mass.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient::study {
namespace {

TEST(PotentialFlowStudy, MeasuresASpheroidOfFewTrianglesWithinItsTarget) {
  const Vector3 semi_axes(1, 1, 2);
  AccuracyCase spheroid;
  spheroid.mesh = scaledToVolume(makeEllipsoidMesh(semi_axes, 320), 8 * std::acos(-1.0) / 3);
  const Reference exact{reference::ellipsoidAddedMass(semi_axes).asDiagonal(), 0};
  const Matrix6 K = builtAddedMass(spheroid.mesh, false, 0, 1);
  const AccuracyRow row = compareAddedMass(K, exact, spheroid.symmetry);
  EXPECT_LT(row.translation, 5e-3);
  EXPECT_LT(row.rotation, 0.02);
  EXPECT_LT(row.should_be_zero, 1e-6);  // measured 4e-8: error of near pairs' quadrature
}

TEST(PotentialFlowStudy, ComparesEntryByEntry) {
  Reference exact;
  exact.added_mass.diagonal() << 4, 4, 2, 9, 9, 5;
  Matrix6 K = exact.added_mass;
  K(2, 2) += 0.04;
  K(5, 5) -= 0.18;
  K(0, 4) = K(4, 0) = 0.6;
  K(0, 3) = K(3, 0) = 0.06;
  const AccuracyRow row = compareAddedMass(K, exact, Symmetry::kTwoMirrors);
  EXPECT_NEAR(row.rotation, 0.01, 1e-12);
  EXPECT_NEAR(row.translation, 0.02, 1e-12);
  EXPECT_NEAR(row.coupling, 0.1, 1e-12);
  EXPECT_NEAR(row.should_be_zero, 0.01, 1e-12) << "(w_x, v_y) may differ from zero";
  EXPECT_NEAR(compareAddedMass(K, exact, Symmetry::kThreeTurns).should_be_zero, 0.1, 1e-12);
  EXPECT_NEAR(compareAddedMass(K, exact, Symmetry::kFlatSheet).should_be_zero, 1, 1e-12);
}

TEST(PotentialFlowStudy, ExtrapolationIsCloserThanItsFinestMesh) {
  const double exact = 8 * reference::cubeAddedMassCoefficient();
  const TriangleMesh coarse = makeBoxMesh({1, 1, 1}, 192), fine = makeBoxMesh({1, 1, 1}, 432);
  const Reference extrapolated = extrapolate(coarse, fine, false, 2.6);
  const double error = std::abs(extrapolated.added_mass(3, 3) / exact - 1);
  EXPECT_LT(error, 0.2 * std::abs(builtAddedMass(fine, false, 0)(3, 3) / exact - 1));
  EXPECT_GT(extrapolated.correction, error);
}

TEST(PotentialFlowStudy, SolidsHaveTheVolumeOfTheirFormula) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  const auto edgeOf = [](const TriangleMesh& mesh) {
    double shortest = 10;
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
      for (int k = 0; k < 3; ++k)
        shortest = std::min(shortest, (mesh.corner(t, k) - mesh.corner(t, (k + 1) % 3)).norm());
    return shortest;
  };
  const TriangleMesh icosahedron = makeIcosahedron(), dodecahedron = makeDodecahedron();
  EXPECT_NEAR(test::volumeOf(makeOctahedron()), 4.0 / 3, 1e-12);
  EXPECT_NEAR(test::volumeOf(icosahedron),
              5.0 / 6 * golden * golden * std::pow(edgeOf(icosahedron), 3), 1e-12);
  const double dodecahedron_volume =
      (15 + 7 * std::sqrt(5.0)) / 4 * std::pow(edgeOf(dodecahedron), 3);
  EXPECT_NEAR(test::volumeOf(dodecahedron), dodecahedron_volume, 1e-12);
  EXPECT_NEAR(test::volumeOf(gradedTowardsEdges(makeCentredDodecahedron(), 3)), dodecahedron_volume,
              1e-12);
}

TEST(PotentialFlowStudy, MeshesAreClosed) {
  EXPECT_TRUE(checkMesh(makeOctahedron(), "octahedron").warnings.empty());
  EXPECT_TRUE(checkMesh(makeDodecahedron(), "dodecahedron").warnings.empty());
  EXPECT_TRUE(checkMesh(gradedTowardsEdges(makeIcosahedron(), 4), "graded").warnings.empty());
  for (const bool graded : {false, true}) {
    const TriangleMesh bowl = makeBowl({0.05, 12, 2, graded});
    EXPECT_TRUE(checkMesh(bowl, "bowl").warnings.empty());
    EXPECT_NEAR(test::volumeOf(bowl) / bowlVolume(0.05), 1, 0.03);
  }
}

}  // namespace
}  // namespace ambient::study
