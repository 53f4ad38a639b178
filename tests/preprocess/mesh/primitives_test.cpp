#include "preprocess/mesh/shapes/primitives.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mass_properties.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

std::vector<NamedMesh> closedMeshes(int faces) {
  return {{"ellipsoid", makeEllipsoidMesh({0.5, 0.3, 0.1}, faces)},
          {"cube", makeBoxMesh({0.5, 0.5, 0.5}, faces)},
          {"box", makeBoxMesh({0.5, 0.3, 0.02}, faces)},
          {"cylinder", makeCylinderMesh(0.3, 0.7, faces)},
          {"coin", makeCylinderMesh(0.3, 0.01, faces)},
          {"capsule", makeCapsuleMesh(0.3, 0.7, faces)},
          {"cone", makeConeMesh(0.3, 0.7, faces)},
          {"needle", makeConeMesh(0.06, 0.9, faces)}};
}

std::vector<NamedMesh> sheetMeshes(int faces) {
  return {{"rectangle", makeRectangularSheetMesh(0.5, 0.2, faces)},
          {"ellipse", makeEllipticSheetMesh(0.5, 0.2, faces)}};
}

std::map<std::pair<int, int>, int> directedEdges(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) ++edges[{mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t)}];
  }
  return edges;
}

double signedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    volume += mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2))) / 6;
  }
  return volume;
}

double leastArea(const TriangleMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Eigen::Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    least = std::min(least, (b - a).cross(c - a).norm() / 2);
  }
  return least;
}

// Tells if the mirror image of each triangle at a coordinate plane is in the mesh.
bool isMirrorSymmetric(const TriangleMesh& mesh, int axis) {
  using Point = std::array<long long, 3>;
  const auto key = [&](int v, double sign) {
    Point point{};
    for (int k = 0; k < 3; ++k) {
      const double x = mesh.vertices(k, v) * (k == axis ? sign : 1.0);
      point[k] = std::llround(x * 1e10);
    }
    return point;
  };
  std::set<std::set<Point>> triangles, mirrored;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    std::set<Point> corners, mirrored_corners;
    for (int k = 0; k < 3; ++k) {
      corners.insert(key(mesh.triangles(k, t), 1));
      mirrored_corners.insert(key(mesh.triangles(k, t), -1));
    }
    triangles.insert(corners);
    mirrored.insert(mirrored_corners);
  }
  return triangles == mirrored;
}

TEST(Primitives, ClosedMeshesHaveEveryEdgeOnceInEachDirection) {
  for (const int faces : {340, 1300}) {
    for (const auto& [name, mesh] : closedMeshes(faces)) {
      const auto edges = directedEdges(mesh);
      for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1) << name;
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << name;
      }
      // Euler's formula for one component: uses every vertex, none doubled.
      EXPECT_EQ(mesh.vertexCount(), 2 + mesh.triangleCount() / 2) << name;
      EXPECT_GT(signedVolume(mesh), 0) << name;
      EXPECT_GT(leastArea(mesh), 0) << name;
    }
  }
}

TEST(Primitives, SheetsAreDiscsWithNormalUp) {
  for (const auto& [name, mesh] : sheetMeshes(400)) {
    const auto edges = directedEdges(mesh);
    std::set<int> boundary;
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << name;
      if (edges.count({edge.second, edge.first}) == 0) boundary.insert(edge.first);
    }
    const auto edge_count = static_cast<Eigen::Index>((edges.size() + boundary.size()) / 2);
    EXPECT_EQ(mesh.vertexCount() - edge_count + mesh.triangleCount(), 1) << name;
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
      const Eigen::Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
      ASSERT_GT((b - a).cross(c - a).z(), 0) << name;
      int on_boundary = 0;
      for (int k = 0; k < 3; ++k)
        on_boundary += static_cast<int>(boundary.count(mesh.triangles(k, t)));
      ASSERT_LT(on_boundary, 3) << name;
    }
  }
}

TEST(Primitives, MeshesAreMirrorSymmetric) {
  std::vector<NamedMesh> meshes = closedMeshes(1300);
  for (NamedMesh& sheet : sheetMeshes(400)) meshes.push_back(std::move(sheet));
  for (const auto& [name, mesh] : meshes) {
    EXPECT_TRUE(isMirrorSymmetric(mesh, 0)) << name;
    EXPECT_TRUE(isMirrorSymmetric(mesh, 1)) << name;
    const bool is_cone = name == "cone" || name == "needle";
    EXPECT_EQ(isMirrorSymmetric(mesh, 2), !is_cone) << name;
  }
}

TEST(Primitives, FaceNumbersStayBelowTheAimAndReachMostOfIt) {
  for (const int faces : {350, 1300, 5000}) {
    std::vector<NamedMesh> meshes = closedMeshes(faces);
    for (NamedMesh& sheet : sheetMeshes(faces)) meshes.push_back(std::move(sheet));
    for (const auto& [name, mesh] : meshes) {
      EXPECT_LE(mesh.triangleCount(), faces) << name;
      EXPECT_GT(mesh.triangleCount(), 0.5 * faces) << name;
    }
  }
  EXPECT_EQ(makeEllipsoidMesh({1, 1, 1}, 1300).triangleCount(), 20 * 8 * 8);
  EXPECT_EQ(makeBoxMesh({1, 1, 1}, 1300).triangleCount(), 12 * 10 * 10);
  EXPECT_EQ(makeBoxMesh({1, 1, 1}, 12).triangleCount(), 12);
}

TEST(Primitives, VerticesLieOnTheSmoothSurface) {
  const double rounding = 1e-15;
  const TriangleMesh ellipsoid = makeEllipsoidMesh({0.5, 0.3, 0.1}, 1300);
  for (Eigen::Index v = 0; v < ellipsoid.vertexCount(); ++v) {
    const Eigen::Vector3d p = ellipsoid.vertices.col(v);
    EXPECT_NEAR(Eigen::Vector3d(p.x() / 0.5, p.y() / 0.3, p.z() / 0.1).norm(), 1, rounding);
  }
  const TriangleMesh capsule = makeCapsuleMesh(0.3, 0.8, 1300);
  for (Eigen::Index v = 0; v < capsule.vertexCount(); ++v) {
    Eigen::Vector3d p = capsule.vertices.col(v);
    p.z() -= std::clamp(p.z(), -0.4, 0.4);
    EXPECT_NEAR(p.norm(), 0.3, rounding);
  }
  const TriangleMesh cone = makeConeMesh(0.3, 0.8, 1300);
  for (Eigen::Index v = 0; v < cone.vertexCount(); ++v) {
    const Eigen::Vector3d p = cone.vertices.col(v);
    if (p.z() == -0.4) continue;  // the base
    EXPECT_NEAR(p.head<2>().norm(), 0.3 * (0.4 - p.z()) / 0.8, rounding);
  }
}

TEST(Primitives, VolumesConvergeToTheSmoothBodyWithSecondOrder) {
  const double r = 0.3, h = 0.7;
  struct Case {
    std::string name;
    double volume;
    std::function<TriangleMesh(int)> make;
  };
  const std::vector<Case> cases{
      {"ellipsoid", 4 * kPi / 3 * 0.5 * 0.3 * 0.1,
       [](int n) {
         return makeEllipsoidMesh({0.5, 0.3, 0.1}, n);
       }},
      {"cylinder", kPi * r * r * h, [=](int n) { return makeCylinderMesh(r, h, n); }},
      {"capsule", kPi * r * r * (h + 4 * r / 3), [=](int n) { return makeCapsuleMesh(r, h, n); }},
      {"cone", kPi * r * r * h / 3, [=](int n) { return makeConeMesh(r, h, n); }}};
  for (const Case& shape : cases) {
    const TriangleMesh coarse = shape.make(1300), fine = shape.make(20800);
    const double coarse_error = 1 - signedVolume(coarse) / shape.volume;
    const double fine_error = 1 - signedVolume(fine) / shape.volume;
    EXPECT_GT(fine_error, 0) << shape.name;
    const double face_ratio =
        static_cast<double>(fine.triangleCount()) / static_cast<double>(coarse.triangleCount());
    const double order = 2 * std::log(coarse_error / fine_error) / std::log(face_ratio);
    EXPECT_NEAR(order, 2, 0.15) << shape.name << " " << coarse_error << " " << fine_error;
  }
  EXPECT_NEAR(signedVolume(makeBoxMesh({0.5, 0.3, 0.02}, 1300)), 8 * 0.5 * 0.3 * 0.02, 1e-16);
}

TEST(Primitives, ImpossibleSizesAreRefusedByName) {
  EXPECT_EQ(messageOf([] {
              makeEllipsoidMesh({1, -2, 1}, 1000);
            }),
            "ellipsoid: semi-axis = -2 m is not positive and finite");
  EXPECT_EQ(messageOf([] { makeCylinderMesh(std::nan(""), 1, 1000); }),
            "cylinder: radius = nan m is not positive and finite");
  EXPECT_EQ(messageOf([] {
              makeBoxMesh({1, 1, 1}, 11);
            }),
            "box: faces = 11 is below the least possible number 12");
  EXPECT_EQ(messageOf([] {
              makeBoxMesh({1, 1, 1}, 1000000000);
            }),
            "box: faces = 1000000000 is above the largest number 1000000");
}

constexpr double kRounding = 1e-14;  // some hundred additions

double relativeError(const Matrix3& a, const Matrix3& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(MeshProperties, BoxIsExact) {
  const double a = 0.4, b = 0.2, c = 0.1;  // half sizes
  const MeshProperties box = computeMassProperties(makeBoxMesh({a, b, c}, 300));
  EXPECT_NEAR(box.volume / (8 * a * b * c), 1, kRounding);
  EXPECT_NEAR(box.area, 8 * (a * b + b * c + c * a), 1e-15);
  EXPECT_LT(box.uniform.centre.norm(), 1e-16);
  const Matrix3 inertia =
      Eigen::Vector3d(b * b + c * c, c * c + a * a, a * a + b * b).asDiagonal() * (1.0 / 3);
  EXPECT_LT(relativeError(box.uniform.inertia, inertia), kRounding);
}

TEST(MeshProperties, CentresAreExactWhereTheShapeIsSymmetric) {
  const Vector3 somewhere(1.5, -2, 0.25);
  for (const TriangleMesh& mesh :
       {makeEllipsoidMesh({0.37, 0.37, 0.37}, 1300), makeEllipsoidMesh({1, 0.6, 0.3}, 500),
        makeCapsuleMesh(0.3, 1.7, 700), makeBoxMesh({0.1, 0.7, 1.3}, 300)}) {
    for (const Vector3& centre : {Vector3(0, 0, 0), somewhere}) {
      const MeshProperties body = computeMassProperties(moved(mesh, centre));
      EXPECT_LT((body.uniform.centre - centre).norm(), 1e-16 * (1 + centre.norm()));
      EXPECT_EQ(body.uniform.centre, body.surface.centre) << "both are the middle";
      EXPECT_TRUE(body.uniform.inertia.isDiagonal(0) && body.surface.inertia.isDiagonal(0));
    }
    EXPECT_EQ(computeMassProperties(mesh).uniform.centre, Vector3::Zero());
  }
}

TEST(MeshProperties, TetrahedronIsExactWithItsProductsOfInertia) {
  const MeshProperties body = computeMassProperties(unitTetrahedron());
  EXPECT_NEAR(body.volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR(body.area, 1.5 + std::sqrt(3.0) / 2, 1e-15);
  EXPECT_LT((body.uniform.centre - Vector3::Constant(0.25)).norm(), 1e-15);
  // About the centre: <x^2> = 1/10 - 1/16 = 3/80, <x y> = 1/20 - 1/16 = -1/80.
  Matrix3 inertia = Matrix3::Constant(1.0 / 80);
  inertia.diagonal().setConstant(2 * 3.0 / 80);
  EXPECT_LT(relativeError(body.uniform.inertia, inertia), kRounding);
}

// The shell of a box, whose sides are laminas: a mesh of 12 triangles is as exact as any.
TEST(MeshProperties, SurfaceMassIsThatOfAThinShell) {
  const Vector3 half(0.4, 1.1, 0.7);
  const double x = 2 * half.x(), y = 2 * half.y(), z = 2 * half.z();
  const double area = 2 * (x * y + y * z + z * x);
  Vector3 spread;  // mean of the squares of the coordinates
  for (int k = 0; k < 3; ++k) {
    const double length = 2 * half[k], side = x * y * z / length;  // two sides across axis k
    spread[k] = (2 * side * length * length / 4 + (area - 2 * side) * length * length / 12) / area;
  }
  const Matrix3 inertia = (spread.sum() * Vector3::Ones() - spread).asDiagonal();
  for (const int faces : {12, 1000}) {
    const MeshProperties body = computeMassProperties(makeBoxMesh(half, faces));
    EXPECT_LT(relativeError(body.surface.inertia, inertia), kRounding) << faces;
    EXPECT_LT(body.surface.centre.norm(), 1e-15) << faces;
  }
}

TEST(MeshProperties, SheetIsALamina) {
  const double a = 0.4, b = 0.1;
  const MeshProperties sheet = computeSheetMassProperties(makeRectangularSheetMesh(a, b, 300));
  EXPECT_EQ(sheet.volume, 0);
  EXPECT_NEAR(sheet.area, a * b, 1e-16);
  const Matrix3 inertia = Eigen::Vector3d(b * b, a * a, a * a + b * b).asDiagonal() * (1.0 / 12);
  EXPECT_LT(relativeError(sheet.uniform.inertia, inertia), kRounding);
  const MeshProperties disc = computeSheetMassProperties(makeEllipticSheetMesh(a, a, 20000));
  EXPECT_NEAR(disc.area, kPi * a * a, 2e-3 * disc.area);
  EXPECT_NEAR(disc.uniform.inertia(2, 2), a * a / 2, 2e-3 * a * a / 2);
}

TEST(MeshProperties, TurnWithTheMesh) {
  const TriangleMesh mesh = moved(makeConeMesh(0.3, 0.7, 300), {0.2, -0.1, 0.4});
  const Matrix3 rotation = someRotation();
  const MeshProperties before = computeMassProperties(mesh);
  const MeshProperties after = computeMassProperties(rotated(mesh, rotation));
  EXPECT_NEAR(after.volume, before.volume, kRounding * before.volume);
  EXPECT_LT((after.uniform.centre - rotation * before.uniform.centre).norm(), 1e-15);
  EXPECT_LT((after.surface.centre - rotation * before.surface.centre).norm(), 1e-15);
  EXPECT_LT(relativeError(after.uniform.inertia,
                          rotation * before.uniform.inertia * rotation.transpose()),
            kRounding);
  EXPECT_LT(relativeError(after.surface.inertia,
                          rotation * before.surface.inertia * rotation.transpose()),
            kRounding);
}

TEST(MeshProperties, ScaleWithTheMesh) {
  const TriangleMesh mesh = makeConeMesh(0.3, 0.7, 300);
  const double s = 1e-7;
  const MeshProperties before = computeMassProperties(mesh);
  const MeshProperties after = computeMassProperties(scaled(mesh, s));
  EXPECT_NEAR(after.volume / (s * s * s * before.volume), 1, kRounding);
  EXPECT_NEAR(after.area / (s * s * before.area), 1, kRounding);
  EXPECT_LT(relativeError(after.uniform.inertia, s * s * before.uniform.inertia), kRounding);
}

// Coordinates 10^6 sizes away keep 10 digits of the shape; further loss is an error.
TEST(MeshProperties, FarOffOriginCostsOnlyTheDigitsOfTheCoordinates) {
  const Eigen::Vector3d far(1e6, -2e6, 3e6);
  const TriangleMesh mesh = moved(makeBoxMesh({0.5, 0.3, 0.2}, 300), far);
  const TriangleMesh as_rounded = moved(mesh, -far);  // exact; keeps the coordinates' rounding
  const MeshProperties there = computeMassProperties(mesh);
  const MeshProperties here = computeMassProperties(as_rounded);
  EXPECT_NEAR(there.volume, here.volume, kRounding);
  EXPECT_LT((there.uniform.centre - far - here.uniform.centre).norm(), 1e-9);
  // Coordinates of the centre are rounded to 2^-31, an error that enters inertia squared.
  EXPECT_LT(relativeError(there.uniform.inertia, here.uniform.inertia), kRounding);
  EXPECT_LT(relativeError(there.surface.inertia, here.surface.inertia), kRounding);
}

}  // namespace
}  // namespace ambient
