#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <vector>

#include "demos/simulation/prepared_body.h"

namespace ambient {

/// A btCollisionShape and what it is made of.
struct CollisionShape {
  std::unique_ptr<btTriangleMesh> triangles;
  std::vector<std::unique_ptr<btCollisionShape>> parts;  ///< in order of dependence
  btCollisionShape* root() const { return parts.back().get(); }
};

/// The Bullet shape of a geometry whose frame S has the pose `S_in_B` in the body's frame.
CollisionShape makeCollisionShape(const CollisionGeometry& geometry, const btTransform& S_in_B);

}  // namespace ambient
