#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <vector>

#include "demos/simulation/body_preparation.h"

namespace ambient {

/// A btCollisionShape with the objects that it refers to.
struct CollisionShape {
  std::unique_ptr<btTriangleMesh> triangles;
  std::vector<std::unique_ptr<btCollisionShape>> parts;  ///< children before parents; last: root
  btCollisionShape* root() const { return parts.back().get(); }
};

/// Makes the Bullet shape of a body; `S_in_B`: pose of the shape's frame S in the body's frame B. A
/// primitive if possible, else the triangles (static body) or their convex hull (moving body). The
/// shape of a moving body is always the child of a compound, even if S_in_B is the identity:
/// Bullet treats contacts of plain shapes differently.
CollisionShape makeCollisionShape(const BodyDef& def, const PreparedBody& prepared,
                                  const btTransform& S_in_B);

}  // namespace ambient
