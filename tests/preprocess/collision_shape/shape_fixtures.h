#pragma once

#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/reference/body_added_mass.h"

namespace ambient::test {

/// Rounding of sizes stored in btScalar; all derived numbers inherit it.
constexpr double kScalarRounding = sizeof(btScalar) == sizeof(float) ? 4e-7 : 1e-13;

/// Settings for tests that do not need accuracy: milliseconds instead of seconds.
inline CollisionShapeSettings coarse() {
  CollisionShapeSettings settings;
  settings.faces = 350;
  settings.flow.max_panels = 0;
  return settings;
}

/// The triangles of a mesh, for Bullet.
struct BulletTriangles : btTriangleMesh {
  explicit BulletTriangles(const TriangleMesh& mesh) {
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
      addTriangle(toBullet(Vector3(mesh.corner(t, 0))), toBullet(Vector3(mesh.corner(t, 1))),
                  toBullet(Vector3(mesh.corner(t, 2))));
  }
};

/// A mesh as a collision shape.
struct GImpactMesh {
  explicit GImpactMesh(const TriangleMesh& mesh) : triangles(mesh) { shape.updateBound(); }

  BulletTriangles triangles;
  btGImpactMeshShape shape{&triangles};
};

/// Largest difference of two 3x3 blocks over the largest entry of the reference block.
inline double blockError(const Matrix3& block, const Matrix3& reference) {
  return (block - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

inline double rotationError(const Matrix6& K, const Matrix6& reference) {
  return blockError(K.topLeftCorner<3, 3>(), reference.topLeftCorner<3, 3>());
}

inline double translationError(const Matrix6& K, const Matrix6& reference) {
  return blockError(K.bottomRightCorner<3, 3>(), reference.bottomRightCorner<3, 3>());
}

/// Largest difference of two matrices over the largest entry of the reference. Lengths must be
/// about 1.
inline double differenceOf(const Matrix6& K, const Matrix6& reference) {
  return (K - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

/// Added mass of a body of revolution about an axis, without coupling.
inline Matrix6 alongAxis(const reference::RevolutionAddedMass& about_z, int axis) {
  Vector6 diagonal;
  diagonal << Vector3::Constant(about_z.w_y), Vector3::Constant(about_z.v_x);
  diagonal[axis] = 0;
  diagonal[3 + axis] = about_z.v_z;
  return diagonal.asDiagonal();
}

}  // namespace ambient::test
