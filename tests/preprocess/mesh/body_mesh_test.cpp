#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

std::string bodyRefusal(const TriangleMesh& mesh, bool strict) {
  return messageOf([&] { makeBodyMesh(mesh, "thing.obj", strict); });
}

double enclosedBy(const TriangleMesh& mesh) { return computeMassProperties(mesh).volume; }

/// Volume of the closed surface that stands for a mesh with a defect. Expects one line about it,
/// and a refusal of the same defect by `strict`.
double wrappedVolume(const TriangleMesh& mesh, const std::string& defect) {
  const std::string beginning = "thing.obj: " + defect, strictly = bodyRefusal(mesh, true);
  EXPECT_EQ(strictly.find(beginning), 0u) << strictly;
  EXPECT_NE(strictly.find("(build --wrap makes a closed surface around it)"), std::string::npos);
  const CheckedMesh made = makeBodyMesh(mesh, "thing.obj", false);
  EXPECT_TRUE(isClosed(computeMeshEdges(made.mesh)));
  EXPECT_EQ(made.warnings.size(), 1u);
  EXPECT_EQ(made.warnings.at(0).find(beginning), 0u) << made.warnings[0];
  EXPECT_NE(made.warnings[0].find("; wrapped with a size of "), std::string::npos);
  return enclosedBy(made.mesh);
}

/// A box of side 2 without its upper side.
TriangleMesh openBox() {
  TriangleMesh box = makeBoxMesh({1, 1, 1}, 300);
  for (Eigen::Index t = box.triangleCount() - 1; t >= 0; --t)
    if (box.barycentre(t).z() > 1 - 1e-9) box = withoutTriangle(box, t);
  return box;
}

TEST(BodyMesh, OpenBodiesAreClosed) {
  EXPECT_NEAR(wrappedVolume(openBox(), "not watertight: "), 8, 0.03);
  const TriangleMesh holed = withoutTriangle(makeBoxMesh({1, 1, 1}, 12), 5);
  EXPECT_NEAR(wrappedVolume(holed, "not watertight: 3 boundary edges"), 8, 0.03);
}

TEST(BodyMesh, DoubledOpenBodiesAreClosedToo) {
  const TriangleMesh open = openBox();
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
  EXPECT_NEAR(wrappedVolume(soup, "not watertight: ") / enclosedBy(ball), 1, 0.03);
}

TEST(BodyMesh, CrossingPartsOfWhichOneIsOpenAreTakenTogether) {
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 12);
  const TriangleMesh crossing = joined(moved(box, {1.3, 0.4, 0.3}), withoutTriangle(box, 0));
  EXPECT_NEAR(wrappedVolume(crossing, "not watertight: "), 16 - 0.7 * 1.6 * 1.7, 0.1);
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

TEST(BodyMesh, WhatHasNoTrianglesOrNumbersIsRefused) {
  TriangleMesh broken = makeBoxMesh({1, 1, 1}, 12), unknown = broken;
  broken.vertices(1, 3) = std::numeric_limits<double>::quiet_NaN();
  unknown.triangles(0, 7) = 100;
  for (const bool strict : {false, true}) {
    EXPECT_EQ(bodyRefusal({}, strict), "thing.obj: there are no triangles");
    EXPECT_EQ(bodyRefusal(broken, strict),
              "thing.obj: vertex 3 has the coordinate y = nan, must be finite");
    EXPECT_EQ(bodyRefusal(unknown, strict).find("thing.obj: triangle 7 refers to vertex 100"), 0u);
  }
}

// Six sides of a cube with gaps of a fifth of its edge between them.
TEST(BodyMesh, WhatTheWrapRefusesSaysBothReasons) {
  const TriangleMesh cube = makeBoxMesh({1, 1, 1}, 12);
  TriangleMesh plates;
  plates.vertices.resize(3, 36);
  plates.triangles.resize(3, 12);
  for (int i = 0; i < 36; ++i) {
    plates.triangles(i % 3, i / 3) = i;
    const Eigen::Vector3d corner = cube.corner(i / 3, i % 3);
    plates.vertices.col(i) = corner - 0.2 * (corner - cube.twiceArea(i / 3).normalized());
  }
  const std::string message = bodyRefusal(weldVertices(plates, 1e-9), false);
  EXPECT_EQ(message.find("thing.obj: not watertight: "), 0u) << message;
  EXPECT_NE(message.find("; wrapped with a size of "), std::string::npos) << message;
  EXPECT_NE(message.find("less than half"), std::string::npos) << message;
}

TEST(BodyMesh, TheWarningHasVolumeAndAreaBeforeAndAfter) {
  const TriangleMesh holed = withoutTriangle(makeBoxMesh({1, 1, 1}, 12), 5);
  const std::string line = makeBodyMesh(holed, "thing.obj", false, 10).warnings.at(0);
  const std::size_t at =
      line.find("; wrapped with a size of 0.3464 m: volume 8000 m^3 before and ");
  EXPECT_NE(at, std::string::npos) << line;
  EXPECT_NE(line.find(" m^3 after, area 2200 m^2 before and "), std::string::npos) << line;
}

}  // namespace
}  // namespace ambient
