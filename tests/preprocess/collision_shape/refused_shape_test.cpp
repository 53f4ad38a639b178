#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <gtest/gtest.h>

#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using test::coarse;

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
