#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"
#include "tests/support/convergence.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using test::addedMassOf;
using test::relativeError;

double volumeOf(const Vector3d& semi_axes) { return 4.0 / 3.0 * kPi * semi_axes.prod(); }

/// Largest relative error of translation (block 1) or rotation (block 0). Entries that vanish by
/// symmetry are relative to the largest of their block.
double blockError(const Matrix6& K, const Vector3d& semi_axes, int block) {
  const Vector3d reference = reference::ellipsoidAddedMass(semi_axes).segment<3>(3 * block);
  double worst = 0;
  for (int k = 0; k < 3; ++k) {
    const double value = K(3 * block + k, 3 * block + k);
    worst = std::max(worst, reference[k] > 0 ? relativeError(value, reference[k])
                                             : value / reference.maxCoeff());
  }
  return worst;
}

TEST(LambsEllipsoid, ReferenceHasItsKnownValues) {
  // Lamb, arts. 114 and 115 with 25-digit elliptic integrals.
  const auto K = reference::ellipsoidAddedMass({3, 2, 1});
  const double expected[] = {9.632557631369707,  35.599830507687976, 3.914191474995723,
                             4.6560012697568816, 9.161970906562738,  34.21891765849272};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(K[i] / expected[i], 1, 1e-13) << i;
  EXPECT_NEAR(reference::ellipsoidAddedMass({1, 1, 1})[3], 2 * kPi / 3, 1e-14);
  EXPECT_NEAR(reference::ellipsoidAddedMass({1, 1, 1e-6})[5], 8.0 / 3.0, 1e-5);
}

struct SmoothBody {
  Vector3d semi_axes;
  double translation, rotation;  ///< errors measured after volume correction, rounded up
};

// 3:2:1, 5:5:1, ...: errors with the mesh scaled to the smooth body's volume.
const std::vector<SmoothBody> kBodies = {{{1, 1, 1}, 1.2e-5, 0},      {{3, 2, 1}, 2e-4, 6e-4},
                                         {{5, 5, 1}, 3e-4, 8e-4},     {{1, 1, 0.2}, 3e-4, 8e-4},
                                         {{1, 1, 0.1}, 5e-4, 1.1e-3}, {{2, 1, 1}, 1e-4, 7e-4},
                                         {{1, 1, 0.02}, 9e-4, 1.5e-3}};

TEST(EllipsoidFlow, Of1280TrianglesIsWithin1Point5PercentOfTheSmoothBody) {
  for (const SmoothBody& body : kBodies) {
    // Facets cut off 0.86 % of the volume: 0.86 % in translation, 5/3 of this in rotation.
    const Matrix6 K = addedMassOf(makeEllipsoidMesh(body.semi_axes, 1300));
    const double limit = body.semi_axes.z() < 0.05 ? 0.016 : 0.015;
    EXPECT_LT(blockError(K, body.semi_axes, 1), 0.0095) << body.semi_axes.transpose();
    if (body.rotation > 0) {
      EXPECT_LT(blockError(K, body.semi_axes, 0), limit) << body.semi_axes.transpose();
    }
  }
}

TEST(EllipsoidFlow, WithTheTrueVolumeTheFacetsHardlyMatter) {
  for (const SmoothBody& body : kBodies) {
    const Matrix6 K =
        addedMassOf(makeEllipsoidMesh(body.semi_axes, 1300), volumeOf(body.semi_axes));
    EXPECT_LT(blockError(K, body.semi_axes, 1), body.translation) << body.semi_axes.transpose();
    if (body.rotation > 0) {
      EXPECT_LT(blockError(K, body.semi_axes, 0), body.rotation) << body.semi_axes.transpose();
    }
  }
}

TEST(EllipsoidFlow, ConvergesWithSecondOrder) {
  for (const Vector3d& semi_axes : {Vector3d(1, 1, 1), Vector3d(3, 2, 1), Vector3d(1, 1, 0.2)})
    for (int block : {0, 1}) {
      if (block == 0 && semi_axes.x() == semi_axes.z()) continue;
      const auto convergence = test::measureConvergence(1, 3, [&](int level) {
        return blockError(addedMassOf(makeEllipsoidMesh(semi_axes, 20 << (2 * level))), semi_axes,
                          block);
      });
      EXPECT_NEAR(convergence.order(), 2, 0.12) << semi_axes.transpose() << " block " << block;
    }
}

TEST(SphereFlow, HasAlmostNoRotationalInertia) {
  // Rotation of a smooth sphere has no added mass. The facets' falls with the fourth power of their
  // size.
  const double coarse = addedMassOf(makeEllipsoidMesh({1, 1, 1}, 320))(0, 0);
  const double fine = addedMassOf(makeEllipsoidMesh({1, 1, 1}, 1280))(0, 0);
  EXPECT_LT(fine, 1e-5);
  EXPECT_GT(std::log2(coarse / fine), 3);
}

TEST(SphereFlow, PotentialIsHalfTheNormalVelocity) {
  const double R = 0.4;
  const TriangleMesh mesh = withVolume(makeEllipsoidMesh({R, R, R}, 1300), volumeOf({R, R, R}));
  const PotentialFlow flow = solvePotentialFlow(mesh);
  ASSERT_EQ(flow.potential.rows(), mesh.vertexCount());
  // phi = -R/2 cos(theta) for translation, 0 for rotation. Error of the facets: measured 9e-4 R.
  const Eigen::Matrix3Xd expected = -mesh.vertices / 2;
  EXPECT_LT((flow.potential.rightCols<3>().transpose() - expected).cwiseAbs().maxCoeff(), 2e-3 * R);
  EXPECT_LT(flow.potential.leftCols<3>().cwiseAbs().maxCoeff(), 2e-3 * R * R);
}

TEST(EllipsoidFlow, PotentialOfRotationIsLambs) {
  // Art. 115: phi is proportional to y z for rotation about x, and gives K by definition (7).
  const Vector3d semi_axes(1.5, 1, 0.5);
  const TriangleMesh mesh = makeEllipsoidMesh(semi_axes, 1300);
  const PotentialFlow flow = solvePotentialFlow(mesh, {});
  const Eigen::VectorXd yz = mesh.vertices.row(1).cwiseProduct(mesh.vertices.row(2)).transpose();
  const Eigen::VectorXd phi = flow.potential.col(0);
  const double factor = phi.dot(yz) / yz.dot(yz);
  EXPECT_LT((phi - factor * yz).norm(), 0.02 * phi.norm());
  // int y z (z n_y - y n_z) over the ellipsoid is V (c^2 - b^2) / 5; K = -factor times it.
  const double K = -factor * volumeOf(semi_axes) *
                   (semi_axes.z() * semi_axes.z() - semi_axes.y() * semi_axes.y()) / 5;
  EXPECT_NEAR(std::abs(K) / reference::ellipsoidAddedMass(semi_axes)[0], 1, 0.02);
}

TEST(EllipsoidFlow, OffDiagonalEntriesVanishBySymmetry) {
  Matrix6 K = addedMassOf(makeEllipsoidMesh({3, 2, 1}, 1300));
  K.diagonal().setZero();
  EXPECT_LT(K.cwiseAbs().maxCoeff(), 1e-8 * 35);
}

// Lamb's formulae with Carlson's integrals from another library, checked by quadrature.
TEST(EllipsoidAddedMass, AgreesWithPublishedNumbers) {
  Vector6 three_axes, flat, long_one;
  three_axes << 9.632557631369707, 35.599830507687976, 3.914191474995723, 4.6560012697568816,
      9.161970906562738, 34.21891765849272;
  flat << 0.35465227988364084, 0.35465227988364084, 0, 0.0003273857431984761, 0.0003273857431984761,
      2.658763969103372;
  long_one << 0, 2.0057929172153712, 2.0057929172153712, 1.759417960022179, 5.899579467820822,
      5.899579467820822;
  EXPECT_LT((ellipsoidAddedMass({3, 2, 1}) - three_axes).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((ellipsoidAddedMass({1, 1, 0.01}) - flat).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((ellipsoidAddedMass({2, 1, 1}) - long_one).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(EllipsoidAddedMass, BallHasHalfItsVolume) {
  const Vector6 ball = ellipsoidAddedMass({0.5, 0.5, 0.5});
  EXPECT_EQ(Vector3(ball.head<3>()), Vector3::Zero());
  for (int k = 3; k < 6; ++k) EXPECT_NEAR(ball[k] / (kPi / 12), 1, 1e-15);
}

TEST(EllipsoidAddedMass, AlmostABallHasAlmostNoRotation) {
  const double e = 1e-6, volume = 4 * kPi / 3;
  const Vector6 K = ellipsoidAddedMass({1, 1, 1 + e});
  // Limit for alpha_0 - gamma_0 = 4/5 e: V/5 (2 e)^2 / 3. The next term is smaller by e.
  EXPECT_NEAR(K[0] / (4.0 / 15 * volume * e * e), 1, 1e-5);
  EXPECT_EQ(K[2], 0);
}

TEST(EllipsoidAddedMass, SizeScales) {
  const Vector6 small = ellipsoidAddedMass({3e-4, 2e-4, 1e-4}),
                large = ellipsoidAddedMass({3, 2, 1});
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(small[k] / large[k], 1e-20, 1e-33);
    EXPECT_NEAR(small[3 + k] / large[3 + k], 1e-12, 1e-25);
  }
}

}  // namespace
}  // namespace ambient
