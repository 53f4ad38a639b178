#include "preprocess/mesh/mass_properties.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

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

TEST(MeshProperties, SphereConvergesWithSecondOrder) {
  const double radius = 0.3;
  double last_solid = 0, last_shell = 0;
  for (const int faces : {320, 1280, 5120}) {
    const MeshProperties ball =
        computeMassProperties(makeEllipsoidMesh(Eigen::Vector3d::Constant(radius), faces));
    const double solid = 1 - ball.uniform.inertia(2, 2) / (0.4 * radius * radius);
    const double shell = 1 - ball.surface.inertia(2, 2) / (2.0 / 3 * radius * radius);
    EXPECT_GT(solid, 0);
    EXPECT_GT(shell, 0);
    if (faces > 320) {
      EXPECT_NEAR(last_solid / solid, 4, 0.1) << faces;
      EXPECT_NEAR(last_shell / shell, 4, 0.1) << faces;
    }
    last_solid = solid;
    last_shell = shell;
  }
  EXPECT_LT(last_solid, 2e-3);
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
