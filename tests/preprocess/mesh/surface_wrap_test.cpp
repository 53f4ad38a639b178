#include "preprocess/mesh/wrap/surface_wrap.h"

#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

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

/// Six sides of a cube of side 2 with gaps of `gap` between them.
TriangleMesh cubeOfPlates(double gap) {
  const TriangleMesh cube = boxOf12({1, 1, 1});
  TriangleMesh plates;
  plates.vertices.resize(3, 36);
  plates.triangles.resize(3, 12);
  for (int i = 0; i < 36; ++i) plates.triangles(i % 3, i / 3) = i;
  for (int i = 0; i < 36; ++i) {
    const Eigen::Vector3d normal = (cube.corner(i / 3, 1) - cube.corner(i / 3, 0))
                                       .cross(cube.corner(i / 3, 2) - cube.corner(i / 3, 0))
                                       .normalized();
    const Eigen::Vector3d corner = cube.corner(i / 3, i % 3);
    plates.vertices.col(i) = corner - gap * (corner - normal);
  }
  return plates;
}

// A gap along the edges is sqrt(2) * 0.04 wide.
TEST(SurfaceWrap, ClosesGaps) {
  EXPECT_NEAR(wrappedProperties(cubeOfPlates(0.04), 0.06).volume, 8, 0.05);
}

// Cells of 0.04 pass through gaps of 0.14. The suggested size must work.
TEST(SurfaceWrap, RefusesAShellWhereItsTrianglesSurroundABody) {
  const TriangleMesh plates = cubeOfPlates(0.1);
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

TEST(SurfaceWrap, FillsAMissingSide) {
  TriangleMesh box = makeBoxMesh({1, 1, 1}, 300);
  for (Eigen::Index t = box.triangleCount() - 1; t >= 0; --t) {
    if ((box.corner(t, 0) + box.corner(t, 1) + box.corner(t, 2)).z() > 3 - 1e-9)
      box = withoutTriangle(box, t);
  }
  EXPECT_NEAR(wrappedProperties(box, 0.05).volume, 8, 0.02);
}

TEST(SurfaceWrap, RefusesMoreThanTheConvexHull) {
  // A plate of 2 m x 2 m x 0.2 m without its upper side, with a wall inside.
  TriangleMesh open = makeBoxMesh({1, 1, 0.1}, 300);
  for (Eigen::Index t = open.triangleCount() - 1; t >= 0; --t)
    if (open.barycentre(t).z() > 0.1 - 1e-9) open = withoutTriangle(open, t);
  TriangleMesh wall = makeRectangularSheetMesh(1.8, 0.1, 8);
  const Eigen::Matrix3Xd flat = wall.vertices;
  wall.vertices.row(1) = flat.row(2);
  wall.vertices.row(2) = flat.row(1);
  const TriangleMesh flap = joinMeshes({open, wall});
  EXPECT_NEAR(wrappedProperties(flap, 0.03).volume, 0.8, 0.01);
  const std::string refusal = wrapRefusal(flap, 0.5);
  EXPECT_EQ(refusal.find("thing.obj: wrapped with a size of 0.5 m encloses "), 0u) << refusal;
  EXPECT_NE(refusal.find(" m^3, more than its convex hull of 0.8 m^3"), std::string::npos)
      << refusal;
}

// Reference: a rounded slab over a square of side 2, thickness 1.5 sizes.
TEST(SurfaceWrap, GivesSheetsAThickness) {
  const double size = 0.05, reach = 0.75 * size;
  const auto found = wrappedProperties(makeRectangularSheetMesh(2, 2, 8), size);
  const double slab = 4 * 2 * reach + 4 * kPi * reach * reach + 4 * kPi / 3 * reach * reach * reach;
  EXPECT_NEAR(found.volume / slab, 1, 0.02);
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
