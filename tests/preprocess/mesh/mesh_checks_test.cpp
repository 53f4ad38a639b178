#include "preprocess/mesh/check/mesh_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

/// The mesh that comes of the check. @throws std::runtime_error with the first defect
CheckedMesh sound(const TriangleMesh& mesh, bool sheet = false) {
  return requireSound(checkMesh(mesh, "thing.obj", sheet), "thing.obj");
}

std::string refusal(const TriangleMesh& mesh, bool sheet = false) {
  return messageOf([&] { sound(mesh, sheet); });
}

std::vector<std::string> kindsOf(const TriangleMesh& mesh) {
  std::vector<std::string> kinds;
  for (const MeshDefect& defect : checkSurface(mesh, "thing.obj").defects)
    kinds.push_back(defect.kind);
  return kinds;
}

TriangleMesh cube(double half_size) {
  return makeBoxMesh(Eigen::Vector3d::Constant(half_size), 12);
}

bool areEqual(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

TEST(MeshChecks, SoundMeshesPassUnchanged) {
  for (const TriangleMesh& mesh :
       {makeEllipsoidMesh({0.05, 0.05, 0.01}, 1300), makeBoxMesh({1, 1, 1e-3}, 300),
        makeCylinderMesh(0.01, 3, 400), makeConeMesh(1, 1, 100), unitTetrahedron()}) {
    const CheckedMesh checked = sound(mesh);
    EXPECT_TRUE(areEqual(checked.mesh, mesh));
    EXPECT_TRUE(checked.warnings.empty());
  }
  const TriangleMesh sheet = makeEllipticSheetMesh(1, 2, 100);
  EXPECT_TRUE(areEqual(sound(sheet, true).mesh, sheet));
}

// Limits are relative: equal verdicts from nanometres to gigametres.
TEST(MeshChecks, VerdictsDoNotDependOnTheUnit) {
  for (const double unit : {1e-60, 1e-9, 1.0, 1e9, 1e60}) {
    EXPECT_EQ(refusal(scaled(makeBoxMesh({1, 1, 1e-4}, 300), unit)), "no error") << unit;
    const TriangleMesh collapsed = makeBoxMesh({unit, unit, 1e-8 * unit}, 12);
    EXPECT_NE(refusal(collapsed), "no error") << unit;
  }
}

/// A mesh with further vertices and triangles.
TriangleMesh with(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& vertices,
                  const std::vector<Eigen::Vector3i>& triangles) {
  const TriangleMesh more = meshOf(vertices, triangles);
  TriangleMesh both;
  both.vertices.resize(3, mesh.vertexCount() + more.vertexCount());
  both.vertices << mesh.vertices, more.vertices;
  both.triangles.resize(3, mesh.triangleCount() + more.triangleCount());
  both.triangles << mesh.triangles, more.triangles;
  return both;
}

TEST(MeshChecks, WhatCannotBeMendedIsNamed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TriangleMesh whole = unitTetrahedron();
  const auto corner3At = [&](double x, double y, double z) {
    TriangleMesh mesh = whole;
    mesh.vertices.col(3) << x, y, z;
    return mesh;
  };
  const auto triangle3To = [&](int index) {
    TriangleMesh mesh = whole;
    mesh.triangles(2, 3) = index;
    return mesh;
  };
  const std::pair<TriangleMesh, const char*> rows[] = {
      {{}, "there are no triangles"},
      {corner3At(0, std::nan(""), 1), "vertex 3 has the coordinate y = nan, must be finite"},
      {corner3At(0, -kInfinity, 1), "vertex 3 has the coordinate y = -inf, must be finite"},
      {triangle3To(8), "triangle 3 refers to vertex 8, but there are 4 vertices"},
      {triangle3To(-1), "triangle 3 refers to vertex -1, but there are 4 vertices"},
      {corner3At(0.5, 1e-8, 0),
       "triangle 1 is degenerate: its height is 1e-08 of its longest edge, at least 1e-07 needed; "
       "corners 0 (0, 0, 0), 1 (1, 0, 0), 3 (0.5, 1e-08, 0)"},
      {with(whole, {}, {{1, 0, 2}}),
       "triangles 0 and 4 have the same corners: vertices 0 (0, 0, 0), 1 (1, 0, 0), 2 (0, 1, 0)"},
      {withoutTriangle(whole, 3),
       "not watertight: 3 boundary edges, for example from vertex 1 (1, 0, 0) to vertex 2 (0, 1, "
       "0) of triangle 0"}};
  for (const auto& [mesh, words] : rows)
    EXPECT_EQ(refusal(mesh), std::string("thing.obj: ") + words);
  TriangleMesh pointed = whole;
  pointed.triangles(2, 1) = pointed.triangles(1, 1);
  EXPECT_NE(refusal(pointed).find("triangle 1 is degenerate: its height is 0"), std::string::npos);
}

// Divides the edge of one triangle of a tetrahedron, but not of its neighbour.
TriangleMesh tetrahedronWithTJunction(double off_edge) {
  return meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, off_edge, 0}},
                {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

TEST(MeshChecks, WhatIsMendedIsWarnedOf) {
  const TriangleMesh box = makeBoxMesh({1, 2, 3}, 300), turned = insideOut(box);
  TriangleMesh mixed = box, unused = with(cube(1), {{7, 8, 9}, cube(1).vertices.col(0)}, {});
  for (const int t : {0, 7, 100}) mixed.triangles.col(t) = turned.triangles.col(t);
  unused.vertices.col(0) << -7, 8, 9;
  unused.triangles = (unused.triangles.array() == 0).select(9, unused.triangles);
  const std::string count = std::to_string(box.triangleCount()),
                    into_fluid = " triangles were turned round to point into the fluid";
  struct Mended {
    TriangleMesh mesh;
    double volume;
    Eigen::Index vertices, triangles;
    std::string warning;
  };
  const Mended rows[] = {
      // As quadrilaterals with two equal corners leave them, at the keel of a hull.
      {with(unitTetrahedron(), {{0.5, -0.5, 0}}, {{0, 1, 4}, {1, 0, 4}}), 1.0 / 6, 4, 4,
       "folds, opposite triangles on the same corners, were left out: 1"},
      {turned, 48, box.vertexCount(), box.triangleCount(),
       "inside out, " + count + " of " + count + into_fluid},
      {mixed, 48, box.vertexCount(), box.triangleCount(),
       "3 of " + count + " triangles were turned round to agree with their neighbours"},
      {joined(cube(1), moved(insideOut(cube(1)), {5, 0, 0})), 16, 16, 24,
       "inside out, 12 of 24" + into_fluid},
      {unused, 8, 8, 12, "2 vertices belong to no triangle and were left out"},
      {tetrahedronWithTJunction(1e-7), 1.0 / 6, 5, 6,
       "vertices lie on edges of other triangles (T-junctions), which were divided there; "
       "triangles added: 1"}};
  for (const Mended& row : rows) {
    const CheckedMesh checked = sound(row.mesh);
    EXPECT_TRUE(isClosed(computeMeshEdges(checked.mesh))) << row.warning;
    EXPECT_EQ(checked.mesh.vertexCount(), row.vertices) << row.warning;
    EXPECT_EQ(checked.mesh.triangleCount(), row.triangles) << row.warning;
    EXPECT_NEAR(computeMassProperties(checked.mesh).volume, row.volume, 1e-7) << row.warning;
    ASSERT_FALSE(checked.warnings.empty()) << row.warning;
    EXPECT_EQ(checked.warnings[0], "thing.obj: " + row.warning);
  }
}

TEST(MeshChecks, EdgesOfMoreThanTwoTrianglesAreRefused) {
  // A fin on the edge from vertex 0 to vertex 1.
  TriangleMesh mesh = unitTetrahedron();
  mesh.vertices.conservativeResize(3, 5);
  mesh.vertices.col(4) << 0.5, -1, -1;
  mesh.triangles.conservativeResize(3, 5);
  mesh.triangles.col(4) << 0, 1, 4;
  EXPECT_EQ(kindsOf(mesh),
            (std::vector<std::string>{"not watertight", "more than two triangles at an edge",
                                      "parts touch at a vertex"}));
  const std::string message = checkSurface(mesh, "thing.obj").defects.at(1).text;
  EXPECT_EQ(message,
            "not manifold: 1 edges with more than 2 triangles, for example vertex 0 (0, 0, 0) to "
            "vertex 1 (1, 0, 0) with 3");
}

TEST(MeshChecks, VerticesWherePartsTouchAreFound) {
  const TriangleMesh mesh =
      weldVertices(joined(unitTetrahedron(), scaled(insideOut(unitTetrahedron()), -1)), 0);
  const std::vector<MeshDefect> defects = checkSurface(mesh, "thing.obj").defects;
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].text,
            "not manifold: separate parts of the surface touch at vertex 0 (0, 0, 0), triangles 0 "
            "and 4");
  EXPECT_EQ(defects[0].triangles.front(), 0);
}

TEST(MeshChecks, CavitiesAreTakenOutWithAWarning) {
  const TriangleMesh hollow = joined(cube(2), insideOut(cube(1)));
  const std::string warning =
      "thing.obj: 1 cavity of 12.5 % of the volume: the fluid outside does not see what is inside, "
      "which stays dry and only counts as empty in the uniform mass";
  for (const TriangleMesh& mesh : {hollow, insideOut(hollow)}) {
    const CheckedMesh checked = sound(mesh);
    EXPECT_NEAR(computeMassProperties(checked.mesh).volume, 64, 1e-12);
    EXPECT_NEAR(computeMassProperties(joined(checked.mesh, checked.cavities)).volume, 56, 1e-12);
    EXPECT_EQ(checked.warnings.back(), warning);
  }
  const CheckedMesh nested = sound(joined(hollow, cube(0.5)));  // in the cavity
  EXPECT_NEAR(computeMassProperties(nested.mesh).volume, 64, 1e-12);
  EXPECT_NEAR(computeMassProperties(joined(nested.mesh, nested.cavities)).volume, 57, 1e-12);
}

/// Volume of parts united by checkMesh(); expects the warning of a union.
double unitedVolume(const TriangleMesh& mesh) {
  const CheckedMesh united = sound(mesh);
  EXPECT_FALSE(united.warnings.empty());
  if (united.warnings.empty()) return 0;
  EXPECT_NE(united.warnings.back().find("closed parts were united"), std::string::npos);
  return computeMassProperties(united.mesh).volume;
}

TEST(MeshChecks, NestedPartsCountOnce) {
  EXPECT_EQ(checkSurface(joined(cube(2), cube(1)), "thing.obj").defects.at(0).text,
            "the part around triangle 12 at (-1, -1, -1) (12 triangles) lies inside another part "
            "and points outwards: its volume would count twice; leave it out, or turn it round if "
            "it is a cavity");
  EXPECT_NEAR(unitedVolume(joined(cube(2), cube(1))), 64, 1e-9);
}

TEST(MeshChecks, PartsThatOverlapOrTouchAreUnited) {
  const std::string message = "separate parts of the surface overlap or touch at triang";
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 300);
  const auto check = [&](const TriangleMesh& mesh, double volume) {
    EXPECT_EQ(checkSurface(mesh, "thing.obj").defects.at(0).text.find(message), 0u);
    EXPECT_NEAR(unitedVolume(mesh) / volume, 1, 1e-4) << volume;
    EXPECT_NEAR(unitedVolume(scaled(mesh, 1e-3)) / (1e-9 * volume), 1, 1e-4) << volume;
  };
  check(joined(box, moved(box, {1.3, 0.4, 0.3})), 16 - 0.7 * 1.6 * 1.7);
  check(joined(box, moved(box, {2, 0, 0})), 16);      // side by side
  check(joined(box, moved(box, {2, 0.3, 0.2})), 16);  // shifted along the side
  check(joined(box, makeBoxMesh({3, 0.5, 0.5}, 300)), 8 + 4);
  check(joined(box, moved(insideOut(box), {1.3, 0.4, 0.3})), 16 - 0.7 * 1.6 * 1.7);
  EXPECT_EQ(refusal(joined(box, moved(box, {2.001, 0.3, 0.2}))), "no error");
}

// Files with vertices welded across parts contain the common side twice.
TEST(MeshChecks, PartsWithASideInCommonAreUnited) {
  const TriangleMesh row = weldVertices(
      joined(joined(cube(1), moved(cube(1), {2, 0, 0})), moved(cube(1), {4, 0, 0})), 0);
  EXPECT_NE(checkSurface(row, "thing.obj").defects.size(), 0u);
  EXPECT_NEAR(unitedVolume(row), 24, 1e-6);
}

// Overlaps so small that a sample of points would miss them.
TEST(MeshChecks, SmallOverlapsOfLargePartsAreFound) {
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 20000);
  EXPECT_EQ(refusal(joined(ball, moved(ball, {2.001, 0, 0}))), "no error");
  EXPECT_NE(refusal(joined(ball, moved(ball, {1.99, 0, 0}))).find("overlap or touch"),
            std::string::npos);  // too many triangles to unite
}

TEST(MeshChecks, SurfacesThatCrossThemselvesAreWarnedOf) {
  // Pulls one corner of a cube through the opposite side.
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 1200);
  Eigen::Index corner = 0;
  mesh.vertices.colwise().sum().maxCoeff(&corner);
  mesh.vertices.col(corner) << 0.9, 0.9, -1.1;
  const CheckedMesh checked = sound(mesh);
  ASSERT_EQ(checked.warnings.size(), 1u);
  EXPECT_EQ(checked.warnings[0].find("thing.obj: the surface crosses itself at triangle "), 0u)
      << checked.warnings[0];
}

/// A tube of radius 0.15 along a figure of eight; its branches cross at a distance. Overlapping
/// branches enclose the body twice.
TriangleMesh figureOfEight(double distance, int sides) {
  const int rings = 6 * sides;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < rings; ++i) {
    const double u = 2 * kPi * i / rings;
    const Eigen::Vector3d centre(std::sin(u), 0.4 * std::sin(2 * u), distance / 2 * std::cos(u));
    const Eigen::Vector3d along =
        Eigen::Vector3d(std::cos(u), 0.8 * std::cos(2 * u), -distance / 2 * std::sin(u));
    const Eigen::Vector3d across = along.cross(Eigen::Vector3d::UnitZ()).normalized();
    const Eigen::Vector3d up = along.cross(across).normalized();
    for (int k = 0; k < sides; ++k) {
      const double v = 2 * kPi * k / sides;
      vertices.emplace_back(centre + 0.15 * (std::cos(v) * across + std::sin(v) * up));
      const int next_i = (i + 1) % rings, next_k = (k + 1) % sides;
      const int a = i * sides + k, b = next_i * sides + k, c = next_i * sides + next_k,
                d = i * sides + next_k;
      triangles.emplace_back(a, c, b);
      triangles.emplace_back(a, d, c);
    }
  }
  return meshOf(vertices, triangles);
}

TEST(MeshChecks, SurfacesThatEncloseTheBodyTwiceAreJudgedByTheirShareOfTheArea) {
  for (const int sides : {16, 24, 40}) {
    const std::string message = refusal(figureOfEight(0.1, sides));  // on 6 % of the area
    EXPECT_NE(message.find("thing.obj: the volume contradicts itself on "), std::string::npos)
        << sides << ": " << message;
    EXPECT_NE(message.find("encloses the body side 2 times, must be 1 on all but 1 %"),
              std::string::npos)
        << message;
    const CheckedMesh checked = sound(figureOfEight(0.28, sides));  // on 0.7 %
    ASSERT_EQ(checked.warnings.size(), 1u) << sides;
    EXPECT_NE(checked.warnings[0].find("crosses itself"), std::string::npos);
    EXPECT_TRUE(sound(figureOfEight(0.32, sides)).warnings.empty());
  }
}

TEST(MeshChecks, WhatIsOpenOtherwiseIsNotDivided) {
  EXPECT_NE(refusal(tetrahedronWithTJunction(1e-4)).find("not watertight: 3 boundary edges"),
            std::string::npos);
  const TriangleMesh open = withoutTriangle(tetrahedronWithTJunction(0), 4);
  EXPECT_NE(refusal(open).find("not watertight: 6 boundary edges"), std::string::npos)
      << refusal(open);
}

TEST(MeshChecks, SurfacesThatEncloseNothingAreRefused) {
  // Two sheets back to back with a common boundary: closed, manifold, oriented, and flat.
  const TriangleMesh top = makeRectangularSheetMesh(1, 1, 100);
  TriangleMesh pillow = joined(top, insideOut(top));
  pillow = weldVertices(pillow, 0);
  EXPECT_NE(refusal(pillow).find("not watertight"), std::string::npos) << "twice the same sheet";
  const TriangleMesh flat = makeBoxMesh({1, 1, 1e-7}, 300);
  EXPECT_NE(refusal(flat).find("thing.obj: "), std::string::npos);
  const TriangleMesh spheroid = makeEllipsoidMesh({1, 1, 1e-7}, 1300);
  const std::string message = refusal(spheroid);
  EXPECT_NE(message.find("encloses no volume: volume / area^1.5 = "), std::string::npos) << message;
  EXPECT_NE(message.find("at least 1e-06 needed"), std::string::npos) << message;
}

TEST(MeshChecks, OneSidedSurfacesAreRefused) {
  // A strip of ten triangles with ends joined after a half turn.
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  const int n = 10;
  for (int i = 0; i < n; ++i) {
    const double turn = 2 * 3.14159265358979323846 * i / n;
    const Eigen::Vector3d radial(std::cos(turn), std::sin(turn), 0);
    const Eigen::Vector3d across =
        std::cos(turn / 2) * radial + std::sin(turn / 2) * Eigen::Vector3d::UnitZ();
    for (const double offset : {-0.3, 0.0, 0.3}) vertices.push_back(radial + offset * across);
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 2; ++k) {
      const bool last = i + 1 == n;
      const int a = 3 * i + k, b = a + 1;
      const int d = last ? 2 - k : a + 3, c = last ? 1 - k : b + 3;
      triangles.push_back({a, d, c});
      triangles.push_back({a, c, b});
    }
  }
  EXPECT_NE(refusal(meshOf(vertices, triangles), true).find("one-sided"), std::string::npos);
}

TEST(MeshChecks, SheetsMustBeOpenInEveryPart) {
  const std::string ending = "is closed: a sheet needs a boundary (a closed surface is a body)";
  const std::string message = refusal(cube(1), true);
  EXPECT_NE(message.find("thing.obj: the surface around triangle 0 at vertex 0 (-1, "),
            std::string::npos)
      << message;
  EXPECT_NE(message.find(ending), std::string::npos);
  const TriangleMesh mixed = joined(makeRectangularSheetMesh(1, 1, 100), moved(cube(1), {5, 0, 0}));
  EXPECT_NE(refusal(mixed, true).find(ending), std::string::npos);
}

TEST(MeshChecks, VerticesInsideEveryPartOfASheetAreSeen) {
  const TriangleMesh square =
      meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(sound(square, true).mesh.triangleCount(), 2);
  EXPECT_FALSE(hasVerticesInside(square));
  const TriangleMesh fine = makeRectangularSheetMesh(1, 1, 100);
  EXPECT_TRUE(hasVerticesInside(fine));
  EXPECT_FALSE(hasVerticesInside(joined(fine, moved(square, {5, 0, 0}))));
}

TEST(MeshChecks, SheetsKeepTheSideOfMostTriangles) {
  TriangleMesh mesh = makeRectangularSheetMesh(1, 2, 200);
  const TriangleMesh turned = insideOut(mesh);
  mesh.triangles.col(0) = turned.triangles.col(0);
  const CheckedMesh checked = sound(mesh, true);
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Eigen::Vector3d a = checked.mesh.corner(t, 0), b = checked.mesh.corner(t, 1),
                          c = checked.mesh.corner(t, 2);
    EXPECT_GT((b - a).cross(c - a).z(), 0);
  }
  EXPECT_EQ(checked.warnings.size(), 1u);
}

}  // namespace
}  // namespace ambient
