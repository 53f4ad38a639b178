#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using test::coarse;
using test::kScalarRounding;

TEST(ConvexShape, SphereHasTheClosedForm) {
  const FluidBody ball = makeFluidBody(btSphereShape(btScalar(0.75)));
  const double volume = 4 * kPi / 3 * 0.75 * 0.75 * 0.75;
  EXPECT_NEAR(ball.volume / volume, 1, 1e-13);
  Matrix6 expected = Matrix6::Zero();
  expected.bottomRightCorner<3, 3>().diagonal().setConstant(volume / 2);
  EXPECT_LT((ball.added_mass - expected).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_EQ(ball.faces.size(), 80u);  // no load comes from them
  EXPECT_NEAR(ball.area, 4 * kPi * 0.75 * 0.75, 1e-13);
  EXPECT_NEAR(ball.uniform_mass.inertia(0, 0), 0.4 * 0.75 * 0.75, 1e-13);
  EXPECT_EQ(ball.sphere_radius, 0.75);
  checkFluidBody(ball, "ball");
}

TEST(ConvexShape, BoxAndCylinderHaveTheirMarginInside) {
  for (const double margin : {0.0, 0.04, 0.3}) {
    btBoxShape box(btVector3(1, 1, 1));
    box.setMargin(btScalar(margin));
    EXPECT_NEAR(makeFluidBody(box, coarse()).volume / 8, 1, 4 * kScalarRounding);
    btCylinderShapeZ cylinder(btVector3(1, 1, 2));
    cylinder.setMargin(btScalar(margin));
    EXPECT_NEAR(makeFluidBody(cylinder, coarse()).volume / (4 * kPi), 1, 4 * kScalarRounding);
  }
}

// Memory too small for any solver; tables need none.
TEST(ConvexShape, SimpleShapesNeedNoSolver) {
  CollisionShapeSettings settings = coarse();
  settings.flow.max_panels = 100000;
  settings.flow.memory_limit = 1;
  const btBoxShape box(btVector3(1, 2, 3));
  const btCylinderShapeZ cylinder(btVector3(1, 1, 2));
  const btCapsuleShapeZ capsule(1, 2);
  const btConeShapeZ cone(1, 2);
  const std::pair<const btCollisionShape*, std::optional<Matrix6>> shapes[] = {
      {&box, boxAddedMass({1, 2, 3})},
      {&cylinder, cylinderAddedMass(1, 4)},
      {&capsule, capsuleAddedMass(1, 2)},
      {&cone, coneAddedMass(1, 2)}};
  for (const auto& [shape, table] : shapes) {
    const FluidBody body = makeFluidBody(*shape, settings);
    EXPECT_LT(test::differenceOf(body.added_mass, *table), 10 * kScalarRounding)
        << shape->getName();
    EXPECT_EQ(body.provenance.settings,
              "faces 350, load error 0.01 of form law 3, added mass tables 1");
    EXPECT_EQ(body.provenance.settings, describeCollisionShape(*shape, settings).settings);
  }
  settings.tables = false;
  EXPECT_THROW(makeFluidBody(box, settings), std::runtime_error);
  EXPECT_EQ(describeCollisionShape(box, settings).settings,
            "faces 350, load error 0.01 of form law 3, panels 100000, hull, no tables");
}

// Entries forbidden by mirrors are exactly 0: steps have a shorter path for diagonal inertia.
TEST(ConvexShape, SymmetricShapesHaveDiagonalAddedMassAndExactCentres) {
  CollisionShapeSettings settings = coarse();
  settings.flow.max_panels = 700;
  const btVector3 ends[2] = {btVector3(0, -1, 0), btVector3(0, 1, 0)};
  const btScalar radii[2] = {btScalar(0.7), btScalar(0.7)};
  btConvexHullShape hull;
  for (int corner = 0; corner < 8; ++corner) {
    hull.addPoint(btVector3(btScalar(corner % 2 == 0 ? 1 : -1), btScalar(corner / 4 == 0 ? 2 : -2),
                            btScalar(corner / 2 % 2 == 0 ? 0.6 : -0.6)));
  }
  const btSphereShape ball(btScalar(0.37));
  const btBoxShape box(btVector3(btScalar(0.3), btScalar(0.7), btScalar(1.1)));
  const btCylinderShapeX cylinder(btVector3(btScalar(0.9), btScalar(0.3), btScalar(0.3)));
  const btCapsuleShapeX along_x(btScalar(0.4), btScalar(1.3));
  const btCapsuleShape along_y(btScalar(0.4), btScalar(1.3));
  const btCapsuleShapeZ along_z(btScalar(0.4), btScalar(1.3));
  const btMultiSphereShape spheres(ends, radii, 2);
  for (const btCollisionShape* shape : std::initializer_list<const btCollisionShape*>{
           &ball, &box, &cylinder, &along_x, &along_y, &along_z, &spheres, &hull}) {
    const FluidBody body = makeFluidBody(*shape, settings);
    const Matrix6 diagonal = body.added_mass.diagonal().asDiagonal();
    EXPECT_EQ(body.added_mass, diagonal) << shape->getName();
    for (const Vector3& centre :
         {body.centre_of_volume, body.uniform_mass.centre, body.surface_mass.centre})
      EXPECT_EQ(centre, Vector3::Zero()) << shape->getName();
  }
}

TEST(ConvexShape, ScaledSphereOfAMultiSphereIsAnEllipsoid) {
  const btVector3 centre(0, 0, 0);
  const btScalar radius = 1;
  btMultiSphereShape shape(&centre, &radius, 1);
  shape.setLocalScaling(btVector3(3, 2, 1));
  const FluidBody ellipsoid = makeFluidBody(shape);
  const Matrix6 exact = reference::ellipsoidAddedMass({3, 2, 1}).asDiagonal();
  EXPECT_NEAR(ellipsoid.volume / (8 * kPi), 1, 1e-12);
  EXPECT_LT(test::differenceOf(ellipsoid.added_mass, exact), 1e-13);
}

// Limbs of MJCF files.
TEST(ConvexShape, TwoEqualBallsOfAMultiSphereAreACapsuleOfTheTables) {
  const auto r = btScalar(0.4);
  const btScalar radii[2] = {r, r};
  const btVector3 along_y[2] = {btVector3(0, btScalar(-0.6), 0), btVector3(0, btScalar(0.6), 0)};
  const FluidBody capsule = makeFluidBody(btCapsuleShape(r, btScalar(1.2)), coarse());
  const FluidBody balls = makeFluidBody(btMultiSphereShape(along_y, radii, 2), coarse());
  EXPECT_EQ(balls.provenance.settings, capsule.provenance.settings);
  EXPECT_NEAR(balls.volume / capsule.volume, 1, 4 * kScalarRounding);
  EXPECT_LT(test::differenceOf(balls.added_mass, capsule.added_mass), 10 * kScalarRounding);
  EXPECT_EQ(balls.faces.size(), capsule.faces.size());
  EXPECT_LT((balls.centre_of_volume - capsule.centre_of_volume).norm(), 1e-12);

  const btVector3 aslant[2] = {btVector3(1, 2, 3), btVector3(2, 3, 5)};
  const FluidBody limb = makeFluidBody(btMultiSphereShape(aslant, radii, 2), coarse());
  EXPECT_LT((limb.centre_of_volume - Vector3(1.5, 2.5, 4)).norm(), 1e-5);
  const double ends = 4.0 / 3 * 0.4;  // as a cylinder
  EXPECT_NEAR(limb.volume / (kPi * 0.4 * 0.4 * (std::sqrt(6.0) + ends)), 1, 4 * kScalarRounding);
  const Vector3 axis = Vector3(1, 1, 2).normalized();
  const SymmetricEigen<3> eigen = symmetricEigen<3>(limb.added_mass.bottomRightCorner<3, 3>());
  EXPECT_NEAR(std::abs(axis.dot(eigen.vectors.col(0))), 1, 1e-6);

  btTransform moved = btTransform::getIdentity();
  moved.setOrigin(btVector3(-3, 0, 1));
  btMultiSphereShape child(aslant, radii, 2);
  btCompoundShape compound;
  compound.addChildShape(moved, &child);
  EXPECT_LT((makeFluidBody(compound, coarse()).centre_of_volume - Vector3(-1.5, 2.5, 5)).norm(),
            1e-5);
}

/// Checks that K of a shape about axis x or y is K about z with permuted axes.
template <class AlongX, class AlongY, class AlongZ>
void expectSameAlongAllAxes(const AlongX& x, const AlongY& y, const AlongZ& z) {
  Matrix3 z_to_x = Matrix3::Zero(), z_to_y = Matrix3::Zero();
  z_to_x(0, 2) = z_to_x(1, 0) = z_to_x(2, 1) = 1;
  z_to_y(1, 2) = z_to_y(2, 0) = z_to_y(0, 1) = 1;
  const FluidBody along_z = makeFluidBody(z, coarse());
  const FluidBody along_x = makeFluidBody(x, coarse());
  const FluidBody along_y = makeFluidBody(y, coarse());
  EXPECT_GT(along_z.added_mass(0, 0), 2 * std::abs(along_z.added_mass(2, 2)));
  const double tolerance = 10 * kScalarRounding + 1e-11;
  EXPECT_LT(test::differenceOf(along_x.added_mass, rotateAxes(along_z.added_mass, z_to_x)),
            tolerance);
  EXPECT_LT(test::differenceOf(along_y.added_mass, rotateAxes(along_z.added_mass, z_to_y)),
            tolerance);
  EXPECT_LT((along_x.centre_of_volume - z_to_x * along_z.centre_of_volume).norm(), tolerance);
  EXPECT_LT((along_y.centre_of_volume - z_to_y * along_z.centre_of_volume).norm(), tolerance);
}

TEST(ConvexShape, RoundShapesAreTheSameAlongEveryAxis) {
  const btScalar r(0.5), h(1.5);
  expectSameAlongAllAxes(btCylinderShapeX(btVector3(h / 2, r, r)),
                         btCylinderShape(btVector3(r, h / 2, r)),
                         btCylinderShapeZ(btVector3(r, r, h / 2)));
  expectSameAlongAllAxes(btCapsuleShapeX(r, h), btCapsuleShape(r, h), btCapsuleShapeZ(r, h));
  expectSameAlongAllAxes(btConeShapeX(r, h), btConeShape(r, h), btConeShapeZ(r, h));
}

TEST(ConvexShape, ConeHasItsApexUpAndNoMargin) {
  btConeShapeZ cone(btScalar(0.05), btScalar(0.1));
  for (const double margin : {0.0, 0.04}) {  // Bullet's default
    cone.setMargin(btScalar(margin));
    const FluidBody body = makeFluidBody(cone, coarse());
    EXPECT_NEAR(body.volume / (kPi * 0.05 * 0.05 * 0.1 / 3), 1, 10 * kScalarRounding);
    // Centre: a quarter of the height above the base, up to the facets.
    EXPECT_NEAR(body.centre_of_volume.z(), -0.025, 5e-4);
  }
}

TEST(ConvexShape, LocalScalingCounts) {
  btBoxShape box(btVector3(1, 2, 3));
  box.setLocalScaling(btVector3(2, 1, btScalar(0.5)));
  EXPECT_NEAR(makeFluidBody(box, coarse()).volume / 48, 1, 4 * kScalarRounding);
  btSphereShape ball(1);
  ball.setLocalScaling(btVector3(2, 2, 2));
  EXPECT_NEAR(makeFluidBody(ball, coarse()).volume / (32 * kPi / 3), 1, 4 * kScalarRounding);
  btCapsuleShape capsule(1, 2);
  capsule.setLocalScaling(btVector3(2, 2, 2));
  EXPECT_NEAR(makeFluidBody(capsule, coarse()).volume / (80 * kPi / 3), 1, 4 * kScalarRounding);
}

TEST(ConvexShape, UniformScalingScalesWhateverItHolds) {
  btBoxShape box(btVector3(1, 2, 3));
  const FluidBody plain = makeFluidBody(box, coarse());
  const FluidBody scaled = makeFluidBody(btUniformScalingShape(&box, btScalar(0.5)), coarse());
  EXPECT_LT(test::differenceOf(scaled.added_mass, scaleShape(plain.added_mass, 0.5)), 1e-10);
}

TEST(MeshShape, GImpactMeshIsTakenAsItIs) {
  const TriangleMesh cone = makeConeMesh(0.5, 1.2, 300);
  test::GImpactMesh mesh(cone);
  const FluidBody body = makeFluidBody(mesh.shape, coarse());
  BuildSettings settings;
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.max_panels = 0;
  const FluidBody expected = makeFluidBody(cone, settings);
  EXPECT_EQ(body.faces.size(), expected.faces.size());
  EXPECT_NEAR(body.volume / expected.volume, 1, 10 * kScalarRounding);
  EXPECT_LT(test::differenceOf(body.added_mass, expected.added_mass), 100 * kScalarRounding);
}

TEST(MeshShape, GImpactMeshScales) {
  test::GImpactMesh mesh(makeBoxMesh({1, 1, 1}, 200));
  mesh.shape.setLocalScaling(btVector3(1, 2, btScalar(0.25)));
  mesh.shape.updateBound();
  EXPECT_NEAR(makeFluidBody(mesh.shape, coarse()).volume, 4, 4 * kScalarRounding);
}

TEST(MeshShape, CavitiesDoNotDisplace) {
  const TriangleMesh outside = makeBoxMesh({1, 1, 1}, 200);
  test::GImpactMesh mesh(joined(outside, moved(insideOut(unitTetrahedron()), {-0.2, -0.2, -0.2})));
  const FluidBody body = makeFluidBody(mesh.shape, coarse());
  EXPECT_NEAR(body.volume, 8, 8 * kScalarRounding);
  EXPECT_EQ(body.faces.size(), static_cast<std::size_t>(outside.triangleCount()));
  // Tetrahedral cavity: volume 1/6, centre at 0.05.
  EXPECT_NEAR(body.uniform_mass.centre.x(), -0.05 / 6 / (8 - 1.0 / 6), 1e-6);
}

// Makes the body of the mesh itself, and by the cache at size 1: both warnings are in metres.
TEST(MeshShape, HolesOfOpenMeshesAreFilledUnlessStrict) {
  test::GImpactMesh mesh(withoutTriangle(scaled(unitTetrahedron(), 10), 0));
  CollisionShapeSettings settings = coarse();
  std::vector<std::string> lines;
  settings.report = [&](const std::string& line) {
    if (line.rfind("GImpactMesh: ", 0) == 0) lines.push_back(line);  // others say what takes long
  };
  EXPECT_NEAR(6 * makeFluidBody(mesh.shape, settings).volume, 1000, 1000 * kScalarRounding);
  FluidBodyCache cache(settings);
  EXPECT_NEAR(6 * cache.fluidBody(mesh.shape)->volume, 1000, 1000 * kScalarRounding);
  ASSERT_EQ(lines.size(), 2u);
  for (const std::string& line : lines) {
    EXPECT_EQ(line.find("GImpactMesh: not watertight: 3 boundary edges"), 0u) << line;
    EXPECT_NE(line.find("; holes filled: 1, of 50 m^2 in all"), std::string::npos) << line;
  }
  settings.strict = true;
  const std::string message = messageOf([&] { makeFluidBody(mesh.shape, settings); });
  EXPECT_EQ(message.find("GImpactMesh: not watertight: 3 boundary edges"), 0u) << message;
  EXPECT_NE(describeCollisionShape(mesh.shape, settings).settings.find(", strict"),
            std::string::npos);
}

TEST(MeshShape, WhatWasSaidOfItIsKeptWithItsForm) {
  const TemporaryFolder folder;
  test::GImpactMesh mesh(withoutTriangle(unitTetrahedron(), 0));
  CollisionShapeSettings settings = coarse();
  std::vector<std::string> told, told_later;
  const auto tell = [](std::vector<std::string>& lines) {
    return [&lines](const std::string& line) {
      if (line.rfind("making ", 0) != 0) lines.push_back(line);
    };
  };
  settings.report = tell(told);
  FluidBodyCache cache(settings, folder.path());
  settings.report = tell(told_later);
  FluidBodyCache later(settings, folder.path());
  const std::vector<std::string> said = cache.said(*cache.fluidBody(mesh.shape));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].find("GImpactMesh: not watertight: 3 boundary edges"), 0u) << said[0];
  mesh.shape.setLocalScaling({2, 2, 2});
  mesh.shape.updateBound();
  EXPECT_EQ(cache.said(*cache.fluidBody(mesh.shape)), said);
  EXPECT_EQ(cache.said(scaled(*cache.fluidBody(mesh.shape), 3)), said);
  EXPECT_EQ(cache.counts().made, 1);
  EXPECT_TRUE(cache.said(*cache.fluidBody(btSphereShape(1))).empty());
  EXPECT_EQ(later.said(*later.fluidBody(mesh.shape)), said) << "read from the folder";
  EXPECT_EQ(later.counts().read, 1);
  EXPECT_EQ(told, said);
  EXPECT_EQ(told_later, said);
}

std::string refusalOf(const btCollisionShape& shape) {
  CollisionShapeSettings settings = coarse();
  settings.name = "thing";
  return messageOf([&] { makeFluidBody(shape, settings); });
}

TEST(RefusedShape, PlanesFieldsAndEmptyShapesAreNoBodies) {
  EXPECT_EQ(refusalOf(btStaticPlaneShape(btVector3(0, 1, 0), 0)),
            "thing: a plane (STATICPLANE) is unbounded and cannot move in a fluid");
  EXPECT_EQ(refusalOf(btEmptyShape()), "thing: an empty shape (Empty) displaces no fluid");
  const float heights[4] = {0, 1, 2, 3};
  EXPECT_EQ(refusalOf(btHeightfieldTerrainShape(2, 2, heights, 1, 0, 3, 1, PHY_FLOAT, false)),
            "thing: a height field (HEIGHTFIELD) encloses no volume and cannot move in a fluid");
}

TEST(RefusedShape, SettingsThatCannotBeAreNamed) {
  const auto refusal = [](int faces, int max_panels, int threads) {
    CollisionShapeSettings settings = coarse();
    settings.name = "thing";
    settings.faces = faces;
    settings.flow.max_panels = max_panels;
    settings.flow.threads = threads;
    return messageOf([&] { makeFluidBody(btBoxShape(btVector3(1, 1, 1)), settings); });
  };
  EXPECT_EQ(refusal(1000000000, 0, 0), "thing: faces = 1000000000 is not between 0 and 1000000");
  EXPECT_EQ(refusal(350, -1, 0), "thing: max_panels = -1 is not between 0 and 1000000");
  EXPECT_EQ(refusal(350, 0, -1), "thing: threads = -1 is not between 0 and 1000000");
}

TEST(RefusedShape, StaticTriangleMeshesAreToldWhatToUse) {
  btTriangleMesh triangles;
  triangles.addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0));
  btBvhTriangleMeshShape mesh(&triangles, true);
  EXPECT_EQ(refusalOf(mesh),
            "thing: a static triangle mesh (BVHTRIANGLEMESH) cannot move in Bullet: use "
            "btGImpactMeshShape or convex hulls");
  EXPECT_EQ(refusalOf(btScaledBvhTriangleMeshShape(&mesh, btVector3(2, 2, 2)))
                .find("thing: a static triangle mesh (SCALEDBVHTRIANGLEMESH)"),
            0u);
}

TEST(RefusedShape, EmptyAndFlatHulls) {
  btConvexHullShape hull;
  EXPECT_EQ(refusalOf(hull), "thing: a convex hull of 0 points needs at least 4");
  for (const btVector3& point : {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0),
                                 btVector3(1, 1, 0), btVector3(btScalar(0.2), 3, 0)}) {
    hull.addPoint(point);
  }
  EXPECT_EQ(refusalOf(hull), "thing: the points of the hull lie in a plane");
}

TEST(RefusedShape, EmptyCompoundsAndFlatBoxes) {
  EXPECT_EQ(refusalOf(btCompoundShape()), "thing: a compound shape without children is empty");
  EXPECT_EQ(refusalOf(btSphereShape(0)),
            "thing: its half extents are 0 x 0 x 0 m; each must be 1e-09 m to 1e+09 m");
  const std::string flat = refusalOf(btBox2dShape(btVector3(1, 1, 0)));
  EXPECT_NE(flat.find("is not supported"), std::string::npos) << flat;
}

// Refusal names the child of a compound, also from a cache, which solves shapes at size 1.
TEST(RefusedShape, SizesBeyondTheUsualAreNamedWithTheLimit) {
  const auto both = [](const btCollisionShape& shape) {
    CollisionShapeSettings settings = coarse();
    settings.name = "thing";
    const std::string refusal = refusalOf(shape);
    EXPECT_EQ(messageOf([&] { FluidBodyCache(settings).fluidBody(shape); }), refusal);
    return refusal;
  };
  const std::string limit = " m; must be 1e-09 m to 1e+09 m";
  btSphereShape huge(btScalar(1e30));
  EXPECT_EQ(both(huge).find("thing: its largest size or place is 1"), 0u);
  EXPECT_NE(both(huge).find(limit), std::string::npos) << both(huge);
  EXPECT_NE(both(btSphereShape(btScalar(1e-30))).find(limit), std::string::npos);
  btCompoundShape compound;
  btTransform place = btTransform::getIdentity();
  compound.addChildShape(place, &huge);
  EXPECT_EQ(both(compound).find("thing: child 0 (SPHERE): its largest size or place is 1"), 0u);
  EXPECT_NE(refusalOf(btCapsuleShape(btScalar(1e-9), 2))
                .find("the longest must be at most 1000000 times the shortest"),
            std::string::npos);
}

}  // namespace
}  // namespace ambient
