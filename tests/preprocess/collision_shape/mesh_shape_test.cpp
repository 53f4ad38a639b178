#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <gtest/gtest.h>

#include "bullet_ambient/spatial/inertia.h"
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

TEST(MeshShape, OpenMeshesAreRefused) {
  btTriangleMesh triangles;
  addTriangles(withoutTriangle(unitTetrahedron(), 0), triangles);
  btGImpactMeshShape shape(&triangles);
  shape.updateBound();
  const std::string message = messageOf([&] { makeFluidBody(shape, coarse()); });
  EXPECT_EQ(message.find("GImpactMesh: not watertight: 3 boundary edges"), 0u) << message;
}

}  // namespace
}  // namespace ambient
