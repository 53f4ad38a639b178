#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <vector>

#include "demos/simulation/body_preparation.h"

namespace ambient {

/// A btCollisionShape and what it is made of.
struct CollisionShape {
  std::unique_ptr<btTriangleMesh> triangles;
  std::vector<std::unique_ptr<btCollisionShape>> parts;  ///< in order of dependence
  btCollisionShape* root() const { return parts.back().get(); }
};

/// The Bullet shape of a body in whose frame the shape's frame S has the pose `S_in_B`: a
/// primitive, else the convex hull of its surface or, of a static body, the triangles themselves.
/// Of a body that moves it is the child of a compound, wherever it lies: where frames agree to the
/// last bit, contacts shall not differ from where they do not.
CollisionShape makeCollisionShape(const BodyDef& def, const PreparedBody& prepared,
                                  const btTransform& S_in_B);

}  // namespace ambient
