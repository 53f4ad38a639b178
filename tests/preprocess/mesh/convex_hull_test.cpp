#include "preprocess/mesh/shapes/convex_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wings/triangle_tree.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

TriangleMesh hullOf(const Eigen::Matrix3Xd& points) {
  const TriangleMesh hull = makeConvexHull(points, "thing.obj");
  EXPECT_TRUE(isClosed(computeMeshEdges(hull)));
  return hull;
}

/// Largest distance of a point outside of the hull.
double mostOutside(const TriangleMesh& hull, const Eigen::Matrix3Xd& points) {
  double most = 0;
  for (Eigen::Index t = 0; t < hull.triangleCount(); ++t) {
    const Eigen::Vector3d a = hull.corner(t, 0);
    const Eigen::Vector3d normal =
        (hull.corner(t, 1) - a).cross(hull.corner(t, 2) - a).normalized();
    most = std::max(most, (normal.transpose() * (points.colwise() - a)).maxCoeff());
  }
  return most;
}

// Points on a grid over the sides of a box: most lie in planes of facets and on lines of
// edges.
TEST(ConvexHull, GridsOfPointsInPlanesHaveTheHullOfTheBox) {
  for (const int faces : {12, 300, 3000}) {
    const TriangleMesh box = makeBoxMesh({1, 2, 3}, faces);
    const TriangleMesh hull = hullOf(box.vertices);
    EXPECT_NEAR(computeMassProperties(hull).volume, 48, 1e-6) << faces;
    EXPECT_LT(mostOutside(hull, box.vertices), 1e-8);
  }
}

TEST(ConvexHull, NoPointOfACloudLiesOutside) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int cloud = 0; cloud < 20; ++cloud) {
    Eigen::Matrix3Xd points(3, 500);
    for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = normal(random);
    if (cloud % 2 == 0) points = points.array().round();  // many points coplanar or coincident
    EXPECT_LT(mostOutside(hullOf(points), points), 1e-7) << cloud;
  }
}

TEST(ConvexHull, PointsOnABallAreAllCorners) {
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 1280);
  const TriangleMesh hull = hullOf(ball.vertices);
  EXPECT_EQ(hull.vertexCount(), ball.vertexCount());
  EXPECT_EQ(hull.triangleCount(), ball.triangleCount());
}

// Points of a float: on the fine lattice, needles end at points that are off an edge by rounding.
TEST(ConvexHull, OnTheCoarseLatticePointsOffASideByRoundingAreNoCorners) {
  Eigen::Matrix3Xd points = makeBoxMesh({1, 2, 3}, 300).vertices;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] += noise(random);
  EXPECT_GT(hullOf(points).vertexCount(), 20);
  const TriangleMesh hull = makeConvexHull(points, "box", kCoarseHullBits);
  EXPECT_EQ(hull.vertexCount(), 8);
  EXPECT_EQ(hull.triangleCount(), 12);
  EXPECT_NEAR(computeMassProperties(hull).volume, 48, 1e-5);
}

TEST(ConvexHull, PointsWithoutVolumeAreRefused) {
  const auto refusal = [](const Eigen::Matrix3Xd& points) {
    return messageOf([&] { makeConvexHull(points, "thing.obj"); });
  };
  const std::string flat = "thing.obj: the points of the hull lie in a plane";
  EXPECT_EQ(refusal(Eigen::Matrix3Xd(3, 0)),
            "thing.obj: a convex hull of 0 points needs at least 4");
  EXPECT_EQ(refusal(Eigen::Matrix3Xd::Ones(3, 5)), flat);
  EXPECT_EQ(refusal(makeRectangularSheetMesh(1, 1, 200).vertices), flat);
  Eigen::Matrix3Xd broken = makeBoxMesh({1, 1, 1}, 12).vertices;
  broken(1, 3) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(broken), "thing.obj: a point of the hull is not finite");
}

using Polygon = std::vector<Eigen::Vector3d>;

Eigen::Vector3d areaVector(const Polygon& polygon) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += polygon[i].cross(polygon[(i + 1) % polygon.size()]) / 2;
  }
  return sum;
}

// Compares the signed area of the triangles with the polygon's. Equality means cover without
// overlap: a triangle of the other orientation counts negative.
void expectCovered(const Polygon& polygon, const std::string& what) {
  const auto triangles = dividePolygon(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << what;
  const Eigen::Vector3d area = areaVector(polygon);
  double sum = 0;
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3d part = areaVector({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    EXPECT_GT(part.dot(area), 0) << what;
    sum += part.norm();
  }
  EXPECT_NEAR(sum / area.norm(), 1, 1e-13) << what;
}

Polygon inSpace(Polygon polygon) {
  for (Eigen::Vector3d& corner : polygon) {
    corner = someRotation() * corner + Eigen::Vector3d(3, -2, 5);
  }
  return polygon;
}

TEST(PolygonTriangles, CoverPolygonsWithCornersOnStraightSides) {
  const Polygon square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                       {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  expectCovered(square, "square");
  expectCovered(inSpace(square), "square in space");
}

TEST(PolygonTriangles, CoverRandomStars) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 20;
    Polygon star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / n, r = radius(random);
      star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    expectCovered(inSpace(star), "star " + std::to_string(trial));
  }
}

TEST(PolygonTriangles, SplitQuadsAlongTheBetterDiagonal) {
  const Polygon kite{{-1, 0, 0}, {0, -0.1, 0}, {1, 0, 0}, {0, 0.1, 0}};
  for (const Eigen::Vector3i& t : dividePolygon(kite)) {
    EXPECT_TRUE((t.array() == 1).any() && (t.array() == 3).any()) << "the short diagonal is shared";
  }
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

/// A unit ball by meridians and parallels. Triangles at the poles are slivers, `meridians` / 2 pi
/// times as long as wide.
TriangleMesh ballOfMeridians(int meridians, int parallels) {
  const int south = 1 + (parallels - 1) * meridians;
  const auto vertex = [&](int parallel, int meridian) {
    return 1 + (parallel - 1) * meridians + meridian % meridians;
  };
  TriangleMesh mesh;
  mesh.vertices.resize(3, south + 1);
  mesh.triangles.resize(3, 2 * meridians * (parallels - 1));
  mesh.vertices.col(0) = Eigen::Vector3d::UnitZ();
  mesh.vertices.col(south) = -Eigen::Vector3d::UnitZ();
  Eigen::Index t = 0;
  for (int j = 0; j < meridians; ++j) {
    for (int i = 1; i < parallels; ++i) {
      const double polar = kPi * i / parallels, azimuth = 2 * kPi * j / meridians;
      mesh.vertices.col(vertex(i, j)) << std::sin(polar) * std::cos(azimuth),
          std::sin(polar) * std::sin(azimuth), std::cos(polar);
      if (i + 1 == parallels) break;
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1);
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1);
    }
    mesh.triangles.col(t++) << 0, vertex(1, j), vertex(1, j + 1);
    mesh.triangles.col(t++) << vertex(parallels - 1, j), south, vertex(parallels - 1, j + 1);
  }
  return mesh;
}

// Without contraction of slivers 4734 triangles with 27 % more area would remain.
TEST(MeshCoarsening, ContractsTheSliversAroundPoles) {
  const TriangleMesh mesh = ballOfMeridians(360, 60);
  const auto fewer = inFewerTriangles(mesh, 1500);
  ASSERT_TRUE(fewer);
  EXPECT_LE(fewer->triangleCount(), 1500);
  const MeshProperties found = computeMassProperties(*fewer), body = computeMassProperties(mesh);
  EXPECT_NEAR(found.area / body.area, 1, 0.005);
  EXPECT_NEAR(found.volume / body.volume, 1, 1e-12);
  EXPECT_LT(fewer->vertices.colwise().norm().maxCoeff(), 1.01);
}

TEST(MeshCoarsening, OfABodyThatSoFewDoNotShowGivesNone) {
  EXPECT_FALSE(inFewerTriangles(makeEllipsoidMesh({1, 1, 1}, 1280), 20));
}

std::string bodyRefusal(const TriangleMesh& mesh, bool strict) {
  return messageOf([&] { makeBodyMesh(mesh, "thing.obj", strict); });
}

double enclosedBy(const TriangleMesh& mesh) { return computeMassProperties(mesh).volume; }

const std::string kWrapped = "; wrapped with a size of ", kFilled = "; holes filled: ";

/// Volume of what stands for a mesh with a defect: a closed surface around it, or the mesh with its
/// holes filled. Expects a line about it, and a refusal of the same defect by `strict`.
double closedVolume(const TriangleMesh& mesh, const std::string& defect, const std::string& how) {
  const std::string beginning = "thing.obj: " + defect, strictly = bodyRefusal(mesh, true);
  EXPECT_EQ(strictly.find(beginning), 0u) << strictly;
  EXPECT_NE(strictly.find("(build --wrap makes a closed surface around it)"), std::string::npos);
  const CheckedMesh made = makeBodyMesh(mesh, "thing.obj", false);
  EXPECT_TRUE(isClosed(computeMeshEdges(made.mesh)));
  EXPECT_EQ(made.warnings.at(0).find(beginning), 0u) << made.warnings[0];
  EXPECT_NE(made.warnings[0].find(how), std::string::npos) << made.warnings[0];
  EXPECT_EQ(made.is_wrapped, how == kWrapped);
  EXPECT_TRUE(!made.is_wrapped || made.warnings.size() == 1);
  return enclosedBy(made.mesh);
}

TEST(BodyMesh, OpenBodiesAreClosed) {
  EXPECT_NEAR(closedVolume(openBox(makeBoxMesh({1, 1, 1}, 300), 1), "not watertight: ", kFilled), 8,
              1e-12);
  const TriangleMesh holed = withoutTriangle(makeBoxMesh({1, 1, 1}, 12), 5);
  EXPECT_NEAR(closedVolume(holed, "not watertight: 3 boundary edges", kFilled), 8, 1e-12);
}

TEST(BodyMesh, DoubledOpenBodiesAreClosedToo) {
  const TriangleMesh open = openBox(makeBoxMesh({1, 1, 1}, 300), 1);
  const TriangleMesh doubled = weldVertices(joined(open, insideOut(open)), 0);
  const CheckedMesh made = makeBodyMesh(doubled, "thing.obj", false);
  EXPECT_NEAR(enclosedBy(made.mesh), 8, 0.03);
}

// Each triangle of a ball shrunk about its middle, every third one turned round.
TEST(BodyMesh, SoupsOfTrianglesBecomeWhatTheySurround) {
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 1280);
  TriangleMesh soup;
  soup.vertices.resize(3, 3 * ball.triangleCount());
  soup.triangles.resize(3, ball.triangleCount());
  for (int t = 0; t < static_cast<int>(ball.triangleCount()); ++t) {
    for (int k = 0; k < 3; ++k)
      soup.vertices.col(3 * t + k) = 0.95 * ball.corner(t, k) + 0.05 * ball.barycentre(t);
    soup.triangles.col(t) << 3 * t, 3 * t + (t % 3 == 0 ? 2 : 1), 3 * t + (t % 3 == 0 ? 1 : 2);
  }
  EXPECT_NEAR(closedVolume(soup, "not watertight: ", kWrapped) / enclosedBy(ball), 1, 0.03);
}

TEST(BodyMesh, CrossingPartsOfWhichOneIsOpenAreTakenTogether) {
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 12);
  const TriangleMesh crossing = joined(moved(box, {1.3, 0.4, 0.3}), withoutTriangle(box, 0));
  EXPECT_NEAR(closedVolume(crossing, "not watertight: ", kFilled), 16 - 0.7 * 1.6 * 1.7, 1e-9);
}

TEST(BodyMesh, WhatCanBeMendedIsNotWrapped) {
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 12);
  TriangleMesh flipped = box;
  for (Eigen::Index t = 0; t < box.triangleCount(); t += 3)
    flipped.triangles.row(1).col(t).swap(flipped.triangles.row(2).col(t));
  for (const bool strict : {false, true}) {
    EXPECT_EQ(makeBodyMesh(box, "thing.obj", strict).mesh.vertices, box.vertices);
    EXPECT_TRUE(makeBodyMesh(box, "thing.obj", strict).warnings.empty());
    EXPECT_NEAR(enclosedBy(makeBodyMesh(flipped, "thing.obj", strict).mesh), 8, 1e-12);
    const CheckedMesh united =
        makeBodyMesh(joined(box, moved(box, {1.3, 0.4, 0.3})), "thing.obj", strict);
    EXPECT_NEAR(enclosedBy(united.mesh), 16 - 0.7 * 1.6 * 1.7, 1e-9);
    ASSERT_EQ(united.warnings.size(), 1u);
    EXPECT_NE(united.warnings[0].find("closed parts were united"), std::string::npos);
  }
}

TEST(BodyMesh, SheetsAreRefusedWithAHint) {
  const TriangleMesh sheet = makeRectangularSheetMesh(2, 1, 50);
  const TriangleMesh twice = joined(sheet, insideOut(sheet));
  for (const TriangleMesh& mesh : {sheet, weldVertices(twice, 0)}) {
    const std::string message = bodyRefusal(mesh, false);
    EXPECT_EQ(message.find("thing.obj: not watertight: "), 0u) << message;
    EXPECT_NE(message.find("--sheet"), std::string::npos) << message;
    EXPECT_EQ(bodyRefusal(mesh, true).find("thing.obj: not watertight: "), 0u);
  }
  const TriangleMesh flat = makeBoxMesh({1, 1, 1e-8}, 12);
  EXPECT_EQ(bodyRefusal(flat, true),
            bodyRefusal(flat, false) + " (build --wrap makes a closed surface around it)");
}

// Six sides of a cube with gaps of a fifth of its edge between them.
TEST(BodyMesh, WhatTheWrapRefusesSaysBothReasons) {
  const TriangleMesh plates = cubeOfPlates(makeBoxMesh({1, 1, 1}, 12), 0.2);
  const std::string message = bodyRefusal(weldVertices(plates, 1e-9), false);
  EXPECT_EQ(message.find("thing.obj: not watertight: "), 0u) << message;
  EXPECT_NE(message.find("; wrapped with a size of "), std::string::npos) << message;
  EXPECT_NE(message.find("less than half"), std::string::npos) << message;
}

TEST(BodyMesh, TheWarningHasVolumeAndAreaBeforeAndAfter) {
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 12), holed = withoutTriangle(box, 5);
  const std::string filled = makeBodyMesh(holed, "thing.obj", false, 10).warnings.at(0);
  EXPECT_NE(filled.find("; holes filled: 1, of 200 m^2 in all"), std::string::npos) << filled;
  TriangleMesh patched = box;  // by a triangle that ends on its side
  patched.vertices.conservativeResize(3, 11);
  patched.vertices.rightCols(3) << 0.2, 0.6, 0.2, 0.2, 0.2, 0.6, 1, 1, 1.5;
  patched.triangles.conservativeResize(3, 13);
  patched.triangles.col(12) << 8, 9, 10;
  const std::string line = makeBodyMesh(patched, "thing.obj", false, 10).warnings.at(0);
  EXPECT_NE(line.find("; wrapped with a size of "), std::string::npos) << line;
  EXPECT_NE(line.find(" m^3 after, area 24"), std::string::npos) << line;
}

}  // namespace
}  // namespace ambient
