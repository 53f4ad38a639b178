#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/union/mesh_union.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

TEST(MeshMending, OneCopyIsKeptWhereEveryTriangleStandsTwice) {
  const TriangleMesh mesh = makeBoxMesh({1, 2, 3}, 300);
  for (const TriangleMesh& copy : {mesh, insideOut(mesh)}) {
    TriangleMesh doubled = mesh;
    doubled.triangles.resize(3, 2 * mesh.triangleCount());
    doubled.triangles << copy.triangles, mesh.triangles;
    const CheckedMesh checked = checkMesh(doubled, "thing.obj");
    ASSERT_TRUE(checked.defects.empty());
    EXPECT_EQ(checked.mesh.triangleCount(), mesh.triangleCount());
    EXPECT_NEAR(computeMassProperties(checked.mesh).volume, 48, 1e-12);
    EXPECT_EQ(checked.warnings.at(0),
              "thing.obj: every triangle stands twice, one copy of each was left out");
  }
  const TriangleMesh sheet = makeRectangularSheetMesh(1, 1, 100);
  const CheckedMesh checked =
      checkMesh(weldVertices(joined(sheet, insideOut(sheet)), 0), "sheet.obj", true);
  EXPECT_TRUE(checked.defects.empty());
  EXPECT_EQ(checked.mesh.vertices, sheet.vertices);
  EXPECT_EQ(checked.mesh.triangles, sheet.triangles);
}

/// A cube with extra points on an edge of the upper side that the front side lacks. Flat triangles
/// fill the difference.
TriangleMesh cubeWithFlatTriangles(int points, bool is_nested) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 12);
  const int before = static_cast<int>(mesh.vertexCount());
  // Divides the side from corner 0 to 1 of triangle 0, but not its neighbour's.
  const int a = mesh.triangles(0, 0), b = mesh.triangles(1, 0), c = mesh.triangles(2, 0);
  mesh.vertices.conservativeResize(3, before + points);
  std::vector<int> row{a};
  for (int i = 0; i < points; ++i) {
    const double along = (i + 1.0) / (points + 1);
    mesh.vertices.col(before + i) =
        (1 - along) * mesh.vertices.col(a) + along * mesh.vertices.col(b);
    row.push_back(before + i);
  }
  row.push_back(b);
  const Eigen::Index triangles = mesh.triangleCount();
  mesh.triangles.conservativeResize(3, triangles + 2 * points);
  mesh.triangles.col(0) << row[0], row[1], c;
  for (int i = 0; i < points; ++i) {
    mesh.triangles.col(triangles + i) << row[i + 1], row[i + 2], c;
    // Fan from a, or a chain of nested triangles to b.
    if (is_nested) {
      mesh.triangles.col(triangles + points + i) << row[i], b, row[i + 1];
    } else {
      mesh.triangles.col(triangles + points + i) << a, row[i + 2], row[i + 1];
    }
  }
  return mesh;
}

TEST(MeshMending, FlatTrianglesAreJoinedToTheirNeighbours) {
  for (const int points : {1, 2, 7}) {
    for (const bool is_nested : {false, true}) {
      const TriangleMesh mesh = cubeWithFlatTriangles(points, is_nested);
      const CheckedMesh checked = checkMesh(mesh, "thing.obj");
      ASSERT_TRUE(checked.defects.empty());
      EXPECT_EQ(checked.mesh.triangleCount(), 12 + 2 * points);
      const MeshProperties properties = computeMassProperties(checked.mesh);
      EXPECT_NEAR(properties.volume, 8, 1e-14);
      EXPECT_NEAR(properties.area, 24, 1e-13) << "no fold";
      ASSERT_EQ(checked.warnings.size(), 1u);
      EXPECT_NE(checked.warnings[0].find(" flat triangles were joined to their neighbours"),
                std::string::npos);
    }
  }
}

TEST(WeldVertices, JoinsWhatIsCloserThanTheToleranceAndNothingElse) {
  const double tolerance = 1e-3;
  const TriangleMesh soup = meshOf(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0.9e-3}, {1, 1, 0}, {0, 1.0005, 0}, {0, 1, 1.1e-3}},
      {{0, 1, 2}, {3, 4, 5}, {6, 0, 1}, {2, 5, 4}});
  const TriangleMesh welded = weldVertices(soup, tolerance);
  ASSERT_EQ(welded.vertexCount(), 5);
  EXPECT_EQ(welded.vertices.col(1), soup.vertices.col(1));
  ASSERT_EQ(welded.triangleCount(), 3) << "the last triangle has lost a corner";
  EXPECT_EQ(welded.triangles.col(1), Eigen::Vector3i(1, 3, 2));
  EXPECT_EQ(welded.triangles.col(2), Eigen::Vector3i(4, 0, 1));
}

TEST(WeldVertices, FindsNeighboursAcrossCells) {
  // 1000 vertices, each with a copy at 0.9 of the tolerance in a random direction.
  std::vector<Eigen::Vector3d> vertices;
  for (int i = 0; i < 1000; ++i) {
    const int row = i / 10, layer = i / 100;
    const Eigen::Vector3d p(0.1 * (i % 10), 0.1 * (row % 10), 0.1 * layer);
    const Eigen::Vector3d direction(std::sin(i), std::sin(2 * i + 1), std::cos(3 * i));
    vertices.push_back(p);
    vertices.push_back(p + 0.9e-4 * direction.normalized());
  }
  EXPECT_EQ(weldVertices(meshOf(vertices, {}), 1e-4).vertexCount(), 1000);
  EXPECT_EQ(weldVertices(meshOf(vertices, {}), 0.8e-4).vertexCount(), 2000);
}

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

TriangleMesh boxOf12(const Eigen::Vector3d& half_sizes) { return makeBoxMesh(half_sizes, 12); }

/// Properties of the closed surface around a mesh.
MeshProperties wrappedProperties(const TriangleMesh& mesh, double size) {
  const TriangleMesh surface = wrapSurface(mesh, size, "thing.obj").mesh;
  EXPECT_TRUE(isClosed(computeMeshEdges(surface)));
  EXPECT_LE(surface.triangleCount(), 4000);
  return computeMassProperties(surface);
}

std::string wrapRefusal(const TriangleMesh& mesh, double size) {
  return messageOf([&] { wrapSurface(mesh, size, "thing.obj"); });
}

TEST(SurfaceWrap, KeepsSharpBoxesInAnyAttitude) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const Eigen::Matrix3d& rotation : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turn}) {
    const Eigen::Vector3d place(5, -3, 2);
    const auto found =
        wrappedProperties(moved(rotated(boxOf12({1, 0.5, 0.25}), rotation), place), 0.04);
    EXPECT_NEAR(found.volume, 1, 2e-3);
    EXPECT_NEAR(found.area, 7, 2e-3 * 7);
    EXPECT_LT((found.uniform.centre - place).norm(), 2e-3);
  }
}

// Default size: a hundredth of the diagonal; triangles of mixed orientation. The wrap's coarser
// triangles cut off up to a tenth of the size.
TEST(SurfaceWrap, KeepsBalls) {
  TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 5000);
  const MeshProperties own = computeMassProperties(ball);
  for (Eigen::Index t = 0; t < ball.triangleCount(); t += 2)
    std::swap(ball.triangles(0, t), ball.triangles(1, t));
  const double size = kDefaultWrapSize * ball.extents().norm();
  EXPECT_NEAR(wrappedProperties(ball, 0).volume, own.volume, 0.1 * size * own.area);
}

TEST(SurfaceWrap, UnitesPartsAndFillsWhatIsInside) {
  const TriangleMesh box = boxOf12({1, 1, 1});
  EXPECT_NEAR(wrappedProperties(joined(box, moved(box, {1.3, 0.4, 0.3})), 0.05).volume,
              16 - 0.7 * 1.6 * 1.7, 0.02);
  EXPECT_NEAR(wrappedProperties(joined(box, insideOut(boxOf12({0.5, 0.5, 0.5}))), 0.05).volume, 8,
              0.01);
  EXPECT_NEAR(wrappedProperties(joined(box, moved(box, {3, 0, 0})), 0.05).volume, 16, 0.02);
}

// A gap along the edges is sqrt(2) * 0.04 wide.
TEST(SurfaceWrap, ClosesGaps) {
  EXPECT_NEAR(wrappedProperties(cubeOfPlates(boxOf12({1, 1, 1}), 0.04), 0.06).volume, 8, 0.05);
}

// Cells of 0.04 pass through gaps of 0.14. The suggested size must work.
TEST(SurfaceWrap, RefusesAShellWhereItsTrianglesSurroundABody) {
  const TriangleMesh plates = cubeOfPlates(boxOf12({1, 1, 1}), 0.1);
  const std::string refusal = wrapRefusal(plates, 0.04);
  EXPECT_EQ(refusal.find("thing.obj: wrapped with a size of 0.04 m encloses "), 0u) << refusal;
  EXPECT_NE(refusal.find("; a size of 0.08 m closes them"), std::string::npos) << refusal;
  EXPECT_GT(wrappedProperties(plates, 0.08).volume, 0.9 * 8);
}

// Holes: twelve adjacent ones, the others isolated; flat triangles fill them.
TEST(SurfaceWrap, FillsHolesBeforeItWraps) {
  const TriangleMesh whole = makeEllipsoidMesh({1, 0.7, 0.4}, 1280);
  const double volume = computeMassProperties(whole).volume;
  TriangleMesh open = whole;
  for (int i = 24; i >= 0; --i) open = withoutTriangle(open, i < 12 ? 2 * i : 51 * i);
  const CheckedMesh checked = wrapSurface(open, 0.02, "thing.obj");
  EXPECT_NEAR(computeMassProperties(checked.mesh).volume / volume, 1, 0.01);
  ASSERT_GE(checked.warnings.size(), 2u);
  EXPECT_EQ(checked.warnings[1].find("thing.obj: holes filled before that: 25, of "), 0u)
      << checked.warnings[1];
}

// A flap of 18 m x 1.8 m x 11.5 m with holes and with walls inside, aslant: its volume is that of
// its convex hull, or it is refused.
TEST(SurfaceWrap, OfAFlapIsNoLargerThanItsHullAtAnySize) {
  TriangleMesh flap = makeBoxMesh({9, 0.9, 5.75}, 600);
  const int count = static_cast<int>(flap.triangleCount());
  for (const int t : {count - 1, count / 2, 0}) flap = withoutTriangle(flap, t);
  for (const double x : {-4.5, 0.0, 4.5}) {
    TriangleMesh wall = makeRectangularSheetMesh(1.76, 11.46, 32);
    const Eigen::Matrix3Xd flat = wall.vertices;
    wall.vertices.row(0).setConstant(x);
    wall.vertices.row(1) = flat.row(0);
    wall.vertices.row(2) = flat.row(1);
    flap = joinMeshes({flap, wall});
  }
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.9, Eigen::Vector3d(3, 1, 2).normalized()).toRotationMatrix();
  constexpr double kVolume = 18 * 1.8 * 11.5;
  for (const Eigen::Matrix3d& rotation : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turn})
    for (const double size : {0.3, 0.6, 0.9, 1.2, 1.8, 2.5, 3.0, 4.0}) {
      const TriangleMesh mesh = rotated(flap, rotation);
      try {
        EXPECT_NEAR(wrappedProperties(mesh, size).volume / kVolume, 1, 0.02) << size;
      } catch (const std::runtime_error& error) {
        const std::string refusal = error.what();
        EXPECT_GT(size, 0.9) << refusal;
        EXPECT_NE(refusal.find(" m^3, more than its convex hull of 372.6 m^3"), std::string::npos)
            << size << " " << refusal;
      }
    }
}

// Reference: a rounded slab over a square of side 2, thickness 1.5 sizes.
TEST(SurfaceWrap, GivesSheetsAThickness) {
  const double size = 0.05, reach = 0.75 * size;
  const auto found = wrappedProperties(makeRectangularSheetMesh(2, 2, 8), size);
  const double slab = 4 * 2 * reach + 4 * kPi * reach * reach + 4 * kPi / 3 * reach * reach * reach;
  EXPECT_NEAR(found.volume / slab, 1, 0.02);
}

TEST(SurfaceWrap, LeavesNoHolesInPlatesThinnerThanItsGrid) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const TriangleMesh plate = rotated(boxOf12({1, 0.5, 0.015}), turn);
  const TriangleMesh surface = wrapSurface(plate, 0.05, "thing.obj").mesh;
  double above = 0;  // area of all that faces up, seen from there
  for (Eigen::Index t = 0; t < surface.triangleCount(); ++t)
    above += std::max(0.0, surface.twiceArea(t).dot(turn.col(2)) / 2);
  EXPECT_NEAR(above, 2, 0.2) << "a layer of half a step around it, no more";
}

TEST(SurfaceWrap, ReportsTheChangeOfVolumeAndArea) {
  const CheckedMesh checked = wrapSurface(boxOf12({1, 1, 1}), 0.05, "thing.obj");
  ASSERT_FALSE(checked.warnings.empty());
  EXPECT_EQ(checked.warnings[0].find(
                "thing.obj: wrapped with a size of 0.05 m: 800 for 12 triangles, volume "),
            0u)
      << checked.warnings[0];
  EXPECT_NE(checked.warnings[0].find("area"), std::string::npos);
}

TEST(SurfaceWrap, BadInputIsRefusedInOneLine) {
  const TriangleMesh box = boxOf12({1, 1, 1});
  EXPECT_EQ(wrapRefusal({}, 0), "thing.obj: there are no triangles with an area");
  EXPECT_EQ(wrapRefusal(box, -1).find("thing.obj: cannot be wrapped with a size of -1 m: "), 0u);
  EXPECT_EQ(wrapRefusal(box, 10).find("thing.obj: cannot be wrapped with a size of 10 m: "), 0u);
  EXPECT_NE(wrapRefusal(box, 1e-4).find("at most 20000000 are possible"), std::string::npos);
  TriangleMesh broken = box;
  broken.vertices(0, 0) = std::nan("");
  EXPECT_EQ(wrapRefusal(broken, 0), "thing.obj: a vertex has a coordinate that is not finite");
}

TEST(CompactSurface, KeepsVolumeAndEdgesOfAPrismOfManySides) {
  const TriangleMesh prism = makeCylinderMesh(0.5, 1, 640);
  const double volume = computeMassProperties(prism).volume;
  const auto compact = compactSurface(prism, 800);
  ASSERT_TRUE(compact);
  EXPECT_NEAR(static_cast<double>(compact->triangleCount()), 800, 80);
  EXPECT_NEAR(computeMassProperties(*compact).volume / volume, 1, 1e-9);
  EXPECT_NEAR(compact->extents().z(), 1, 5e-3);
  EXPECT_FALSE(compactSurface(boxOf12({1, 1, 1e-3}), 800)) << "too thin for its grid";
}

}  // namespace
}  // namespace ambient
