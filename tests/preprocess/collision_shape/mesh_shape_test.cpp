#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using test::coarse;
using test::kScalarRounding;

void addTriangles(const TriangleMesh& mesh, btTriangleMesh& triangles) {
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    triangles.addTriangle(toBullet(Vector3(mesh.corner(t, 0))),
                          toBullet(Vector3(mesh.corner(t, 1))),
                          toBullet(Vector3(mesh.corner(t, 2))));
  }
}

TEST(MeshShape, GImpactMeshIsTakenAsItIs) {
  const TriangleMesh cone = makeConeMesh(0.5, 1.2, 300);
  btTriangleMesh triangles;
  addTriangles(cone, triangles);
  btGImpactMeshShape shape(&triangles);
  shape.updateBound();
  const FluidBody body = makeFluidBody(shape, coarse());
  BuildSettings settings;
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.max_panels = 0;
  const FluidBody expected = makeFluidBody(cone, settings);
  EXPECT_EQ(body.faces.size(), expected.faces.size());
  EXPECT_NEAR(body.volume / expected.volume, 1, 10 * kScalarRounding);
  EXPECT_LT(test::differenceOf(body.added_mass, expected.added_mass), 100 * kScalarRounding);
}

TEST(MeshShape, GImpactMeshScales) {
  btTriangleMesh triangles;
  addTriangles(makeBoxMesh({1, 1, 1}, 200), triangles);
  btGImpactMeshShape shape(&triangles);
  shape.setLocalScaling(btVector3(1, 2, btScalar(0.25)));
  shape.updateBound();
  EXPECT_NEAR(makeFluidBody(shape, coarse()).volume, 4, 4 * kScalarRounding);
}

TEST(MeshShape, CavitiesDoNotDisplace) {
  const TriangleMesh outside = makeBoxMesh({1, 1, 1}, 200);
  btTriangleMesh triangles;
  addTriangles(joined(outside, moved(insideOut(unitTetrahedron()), {-0.2, -0.2, -0.2})), triangles);
  btGImpactMeshShape shape(&triangles);
  shape.updateBound();
  const FluidBody body = makeFluidBody(shape, coarse());
  EXPECT_NEAR(body.volume, 8, 8 * kScalarRounding);
  EXPECT_EQ(body.faces.size(), static_cast<std::size_t>(outside.triangleCount()));
  // Tetrahedral cavity: volume 1/6, centre at 0.05.
  EXPECT_NEAR(body.uniform_mass.centre.x(), -0.05 / 6 / (8 - 1.0 / 6), 1e-6);
}

// Makes the body of the mesh itself, and by the cache at size 1: both warnings are in metres.
TEST(MeshShape, OpenMeshesAreWrappedUnlessStrict) {
  btTriangleMesh triangles;
  addTriangles(withoutTriangle(scaled(unitTetrahedron(), 10), 0), triangles);
  btGImpactMeshShape shape(&triangles);
  shape.updateBound();
  CollisionShapeSettings settings = coarse();
  std::vector<std::string> lines;
  settings.report = [&](const std::string& line) {
    if (line.rfind("GImpactMesh: ", 0) == 0) lines.push_back(line);  // others say what takes long
  };
  EXPECT_NEAR(6 * makeFluidBody(shape, settings).volume, 1000, 30);
  FluidBodyCache cache(settings);
  EXPECT_NEAR(6 * cache.fluidBody(shape)->volume, 1000, 30);
  ASSERT_EQ(lines.size(), 2u);
  for (const std::string& line : lines) {
    EXPECT_EQ(line.find("GImpactMesh: not watertight: 3 boundary edges"), 0u) << line;
    EXPECT_NE(line.find(": volume 166.7 m^3 before and "), std::string::npos) << line;
  }
  settings.strict = true;
  const std::string message = messageOf([&] { makeFluidBody(shape, settings); });
  EXPECT_EQ(message.find("GImpactMesh: not watertight: 3 boundary edges"), 0u) << message;
  EXPECT_NE(describeCollisionShape(shape, settings).settings.find(", strict"), std::string::npos);
}

}  // namespace
}  // namespace ambient
