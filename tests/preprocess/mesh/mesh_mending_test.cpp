#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
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
      checkMesh(weldVertices(joined(sheet, insideOut(sheet)), 0), "sheet.obj", {true});
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

}  // namespace
}  // namespace ambient
