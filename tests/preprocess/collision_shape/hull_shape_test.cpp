#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTetrahedronShape.h>
#include <gtest/gtest.h>

#include <random>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/reference/body_added_mass.h"

namespace ambient {
namespace {

using test::coarse;
using test::kScalarRounding;

void addCube(btConvexHullShape& hull, btScalar half_size) {
  for (int i = 0; i < 8; ++i) {
    hull.addPoint(half_size * btVector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
}

double steinerCube(double edge, double margin) {
  return edge * edge * edge + 6 * edge * edge * margin + 3 * kPi * edge * margin * margin +
         4 * kPi / 3 * margin * margin * margin;
}

TEST(HullShape, CubeOf8PointsIsRight) {
  btConvexHullShape hull;
  addCube(hull, 1);
  hull.addPoint(btVector3(btScalar(0.2), btScalar(0.3), 0));  // inside
  hull.setMargin(0);
  const FluidBody cube = makeFluidBody(hull);
  EXPECT_NEAR(cube.volume / 8, 1, 1e-13);
  EXPECT_GE(cube.faces.size(), 350u) << "divided for the loads";
  Vector6 exact;
  exact << Vector3::Constant(reference::cubeRotationalAddedMass()),
      Vector3::Constant(8 * reference::cubeAddedMassCoefficient());
  // Measured 7e-3 and 1.2e-3.
  EXPECT_LT(test::rotationError(cube.added_mass, exact.asDiagonal()), 1e-2);
  EXPECT_LT(test::translationError(cube.added_mass, exact.asDiagonal()), 2e-3);
  checkFluidBody(cube, "cube");
}

TEST(HullShape, MarginMakesTheHullLarger) {
  for (const double margin : {0.002, 0.04, 0.5}) {
    btConvexHullShape hull;
    addCube(hull, btScalar(0.5));
    hull.setMargin(btScalar(margin));
    EXPECT_NEAR(makeFluidBody(hull, coarse()).volume / steinerCube(1, margin), 1,
                10 * kScalarRounding)
        << margin;
    CollisionShapeSettings bare = coarse();
    bare.margins = false;
    EXPECT_NEAR(makeFluidBody(hull, bare).volume, 1, 1e-13);
  }
}

TEST(HullShape, MarginsThatAddMoreThanATenthAreReported) {
  btConvexHullShape hull;
  addCube(hull, btScalar(0.1));
  std::vector<std::string> reports;
  CollisionShapeSettings settings = coarse();
  settings.name = "cube";
  settings.report = [&](const std::string& text) { reports.push_back(text); };
  hull.setMargin(btScalar(0.04));  // Bullet's default
  makeFluidBody(hull, settings);
  ASSERT_EQ(reports.size(), 1u);
  // Steiner: 0.008 + 0.04 0.24 + 3 pi 0.2 0.04^2 + 4/3 pi 0.04^3 m^3.
  EXPECT_EQ(reports.front(),
            "cube: the margin that Bullet collides with is part of the body: its volume is 0.02088 "
            "m^3, without the margin it would be 0.008 m^3; set a smaller margin, or leave margins "
            "out (CollisionShapeSettings::margins, --no-margins)");
  btTransform moved = btTransform::getIdentity();
  moved.setOrigin(btVector3(1, 2, 3));
  btUniformScalingShape larger(&hull, 2);
  btCompoundShape compound;
  compound.addChildShape(moved, &larger);
  makeFluidBody(compound, settings);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_NE(reports[1].find("its volume is 0.1671 m^3, without the margin it would be 0.064 m^3"),
            std::string::npos)
      << reports[1];
  hull.setMargin(btScalar(0.003));  // 9.2 %
  makeFluidBody(hull, settings);
  settings.margins = false;
  hull.setMargin(btScalar(0.04));
  makeFluidBody(hull, settings);
  EXPECT_EQ(reports.size(), 2u);
}

// Values rise towards about 1.18 and 5.04 with the number of panels.
TEST(HullShape, RoundedCubeIsWithinThreePercentInRotation) {
  btConvexHullShape hull;
  addCube(hull, btScalar(0.96));
  hull.setMargin(btScalar(0.04));
  const Matrix6 K = makeFluidBody(hull).added_mass;
  EXPECT_NEAR(K(0, 0) / 1.18, 1, 0.03);
  EXPECT_NEAR(K(3, 3) / 5.04, 1, 5e-3);
}

// Compares the surface with Bullet's own support function.
TEST(HullShape, FacesLieOnTheSurfaceThatBulletCollidesWith) {
  btConvexHullShape hull;
  addCube(hull, btScalar(0.5));
  hull.addPoint(btVector3(0, 0, btScalar(1.5)));
  hull.setMargin(btScalar(0.1));
  const FluidBody body = makeFluidBody(hull, coarse());
  double worst = 0;
  for (std::size_t i = 0; i < body.faces.size(); ++i) {
    const Vector3 normal = body.faces.normal(i);
    const double support = toVector3(hull.localGetSupportingVertex(toBullet(normal))).dot(normal);
    worst = std::max(worst, std::abs(support - normal.dot(body.faces.centroid(i))));
  }
  // Facets of the rounded edges; measured 4e-3 of a margin of 0.1.
  EXPECT_LT(worst, 6e-3);
}

TEST(HullShape, WithAHalfMetreMarginAPointIsAlmostABall) {
  btConvexHullShape hull;
  addCube(hull, btScalar(0.001));
  hull.setMargin(btScalar(0.5));
  const FluidBody ball = makeFluidBody(hull);
  const double volume = steinerCube(0.002, 0.5);
  EXPECT_NEAR(ball.volume / volume, 1, 10 * kScalarRounding);
  Matrix3 expected = volume / 2 * Matrix3::Identity();
  EXPECT_LT(test::blockError(ball.added_mass.bottomRightCorner<3, 3>(), expected), 5e-3);
}

TEST(HullShape, RandomHullsAreBodiesOfModestSize) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (const int points : {4, 8, 40, 400}) {
    btConvexHullShape hull;
    for (int i = 0; i < points; ++i) {
      const Vector3 point(coordinate(random), coordinate(random), 0.4 * coordinate(random));
      hull.addPoint(toBullet(point), false);
    }
    hull.recalcLocalAabb();
    double volume = 0;
    for (const double margin : {0.0, 0.001, 0.02, 0.2}) {
      hull.setMargin(btScalar(margin));
      const FluidBody body = makeFluidBody(hull, coarse());
      EXPECT_NO_THROW(checkFluidBody(body, "hull"));
      EXPECT_GT(body.volume, volume) << points << " points, margin " << margin;
      EXPECT_LT(body.faces.size(), 4500u) << points << " points, margin " << margin;
      volume = body.volume;
    }
  }
}

TEST(HullShape, LocalScalingCounts) {
  btConvexHullShape hull;
  addCube(hull, 1);
  hull.setMargin(0);
  hull.setLocalScaling(btVector3(1, 2, btScalar(0.5)));
  EXPECT_NEAR(makeFluidBody(hull, coarse()).volume, 8, 8 * kScalarRounding);
}

TEST(HullShape, TetrahedraAndConvexTriangleMeshesAreHullsToo) {
  const btVector3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(0, 0, 1);
  CollisionShapeSettings bare = coarse();
  bare.margins = false;
  EXPECT_NEAR(makeFluidBody(btBU_Simplex1to4(a, b, c, d), bare).volume * 6, 1, 1e-12);
  btTriangleMesh triangles;
  triangles.addTriangle(a, b, c);
  triangles.addTriangle(a, b, d);
  triangles.addTriangle(b, c, d);
  triangles.addTriangle(c, a, d);
  EXPECT_NEAR(makeFluidBody(btConvexTriangleMeshShape(&triangles), bare).volume * 6, 1, 1e-12);
}

}  // namespace
}  // namespace ambient
