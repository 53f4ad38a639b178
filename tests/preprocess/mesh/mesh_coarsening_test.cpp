#include "preprocess/mesh/wrap/mesh_coarsening.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/wrap/surface_wrap.h"

namespace ambient {
namespace {

/// A unit ball by meridians and parallels. Triangles at the poles are slivers, `meridians` / 2 pi
/// times as long as wide.
TriangleMesh ballOfMeridians(int meridians, int parallels) {
  const int south = 1 + (parallels - 1) * meridians;
  const auto vertex = [&](int parallel, int meridian) {
    return 1 + (parallel - 1) * meridians + meridian % meridians;
  };
  TriangleMesh mesh;
  mesh.vertices.resize(3, south + 1);
  mesh.triangles.resize(3, 2 * meridians * (parallels - 1));
  mesh.vertices.col(0) = Eigen::Vector3d::UnitZ();
  mesh.vertices.col(south) = -Eigen::Vector3d::UnitZ();
  Eigen::Index t = 0;
  for (int j = 0; j < meridians; ++j) {
    for (int i = 1; i < parallels; ++i) {
      const double polar = kPi * i / parallels, azimuth = 2 * kPi * j / meridians;
      mesh.vertices.col(vertex(i, j)) << std::sin(polar) * std::cos(azimuth),
          std::sin(polar) * std::sin(azimuth), std::cos(polar);
      if (i + 1 == parallels) break;
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1);
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1);
    }
    mesh.triangles.col(t++) << 0, vertex(1, j), vertex(1, j + 1);
    mesh.triangles.col(t++) << vertex(parallels - 1, j), south, vertex(parallels - 1, j + 1);
  }
  return mesh;
}

// Without contraction of slivers 4734 triangles with 27 % more area would remain.
TEST(MeshCoarsening, ContractsTheSliversAroundPoles) {
  const TriangleMesh mesh = ballOfMeridians(360, 60);
  const auto fewer = inFewerTriangles(mesh, 1500);
  ASSERT_TRUE(fewer);
  EXPECT_LE(fewer->triangleCount(), 1500);
  const MeshProperties found = computeMassProperties(*fewer), body = computeMassProperties(mesh);
  EXPECT_NEAR(found.area / body.area, 1, 0.005);
  EXPECT_NEAR(found.volume / body.volume, 1, 1e-12);
  EXPECT_LT(fewer->vertices.colwise().norm().maxCoeff(), 1.01);
}

TEST(MeshCoarsening, OfABodyThatSoFewDoNotShowGivesNone) {
  EXPECT_FALSE(inFewerTriangles(makeEllipsoidMesh({1, 1, 1}, 1280), 20));
}

}  // namespace
}  // namespace ambient
