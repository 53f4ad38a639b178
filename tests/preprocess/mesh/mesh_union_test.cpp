#include "preprocess/mesh/union/mesh_union.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

class MeshUnion : public ::testing::Test {
 protected:
  double random() { return static_cast<double>(generator_()) / std::mt19937::max(); }
  Eigen::Vector3d randomVector() {
    const double x = random(), y = random(), z = random();
    return 2 * Eigen::Vector3d(x, y, z) - Eigen::Vector3d::Ones();
  }

  // Two hulls on both sides of a plane, as in a convex decomposition. Corners on the plane differ
  // by `apart` and by the single precision of files.
  std::vector<TriangleMesh> hullsSideBySide(double apart) {
    constexpr int kCommon = 12, kOwn = 20;
    const Eigen::Vector3d normal = randomVector().normalized();
    const auto inPlane = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return x - normal.dot(x) * normal;
    };
    Eigen::Matrix3Xd below(3, kCommon + kOwn), above(3, kCommon + kOwn);
    for (int i = 0; i < kCommon; ++i) {
      const Eigen::Vector3d corner = inPlane(randomVector()).normalized();
      below.col(i) = corner + apart * randomVector();
      above.col(i) = corner + apart * randomVector();
    }
    for (int i = kCommon; i < kCommon + kOwn; ++i) {
      below.col(i) = 0.7 * inPlane(randomVector()) - (0.2 + 0.8 * random()) * normal;
      above.col(i) = 0.7 * inPlane(randomVector()) + (0.2 + 0.8 * random()) * normal;
    }
    const auto inSinglePrecision = [](const Eigen::Matrix3Xd& points) {
      return makeConvexHull(points.cast<float>().cast<double>(), "hull");
    };
    return {inSinglePrecision(below), inSinglePrecision(above)};
  }

  std::mt19937 generator_;
};

double volumeOf(const TriangleMesh& mesh) { return computeMassProperties(mesh).volume; }

// Sides cross at angles of some 1e-4, or lie as far apart: slivers of this width.
TEST_F(MeshUnion, NineOfTenPairsOfHullsNearlyFlushAreUnited) {
  constexpr int kPairs = 30;
  for (const double apart : {3e-5, 1e-4, 3e-4}) {
    int united_pairs = 0;
    for (int i = 0; i < kPairs; ++i) {
      const std::vector<TriangleMesh> parts = hullsSideBySide(apart);
      TriangleMesh united;
      try {
        united = uniteMeshes(parts, "pair").mesh;
      } catch (const std::runtime_error&) {
        continue;
      }
      ++united_pairs;
      EXPECT_TRUE(isClosed(computeMeshEdges(united)));
      const MeshProperties a = computeMassProperties(parts[0]), b = computeMassProperties(parts[1]),
                           both = computeMassProperties(united);
      EXPECT_NEAR(both.volume / (a.volume + b.volume), 1, 5e-3) << apart << ", pair " << i;
      EXPECT_LT(both.area, 0.9 * (a.area + b.area)) << apart << ", pair " << i;
    }
    EXPECT_GE(united_pairs, 0.9 * kPairs) << apart;
  }
}

TEST_F(MeshUnion, BoxesTurnedAgainstEachOtherByLittleAreUnited) {
  const TriangleMesh box = makeBoxMesh({0.5, 0.5, 0.5}, 48);
  for (const double angle : {1e-5, 3e-5, 1e-4, 3e-4, 1e-3}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::AngleAxisd turn(angle, randomVector().normalized());
      const TriangleMesh turned = moved(rotated(box, turn.toRotationMatrix()), {0.5, 0, 0});
      TriangleMesh united;
      ASSERT_NO_THROW(united = uniteMeshes({box, turned}, "boxes").mesh) << angle << ", box " << i;
      EXPECT_TRUE(isClosed(computeMeshEdges(united)));
      EXPECT_NEAR(volumeOf(united) / 1.5, 1, 5e-3);
    }
  }
}

TEST_F(MeshUnion, IsTheSameEveryTime) {
  const std::vector<TriangleMesh> parts = hullsSideBySide(1e-4);
  const TriangleMesh once = uniteMeshes(parts, "pair").mesh,
                     again = uniteMeshes(parts, "pair").mesh;
  ASSERT_EQ(once.vertices, again.vertices);
  EXPECT_EQ(once.triangles, again.triangles);
}

TEST_F(MeshUnion, PlatesAlongANarrowGapAreRefused) {
  const TriangleMesh plate = makeBoxMesh({0.5, 0.5, 0.01}, 48);
  const std::string message = messageOf([&] {
    uniteMeshes({plate, moved(plate, {0, 0, 0.0205})}, "plates");
  });
  EXPECT_EQ(message, "a gap between them is too narrow for the flow");
}

}  // namespace
}  // namespace ambient
