#pragma once

#include <btBulletCollisionCommon.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "demos/analysis/motion_sample.h"
#include "demos/simulation/body_preparation.h"

class btMultiBodyDynamicsWorld;

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

/// One body in the world of a scene. B: Bullet's body frame, origin at the centre of mass,
/// principal axes. S: frame of the shape.
struct WorldBody {
  std::string name;
  MotionSample start;                        ///< motion at t = 0
  bool is_at_start = true;                   ///< false: it was put elsewhere before the first step
  Matrix3 R_SB = Matrix3::Identity();        ///< rotation from B's axes to S's
  Quaternion to_B = Quaternion::Identity();  ///< of a rigid body: the inverse rotation
  CollisionShape shape;
  std::vector<btTransform> children;  ///< parts of the shape as made; empty: they have not moved
  std::unique_ptr<btRigidBody> body;  ///< null: the body is a link of a robot
  std::optional<SceneLink> link;      ///< none: the body is a rigid body
  std::shared_ptr<const FluidBody> fluid_body;
  std::optional<Immersed> immersed;  ///< none: the fluid does not act on the body

  /// Bullet's number of the link; -1: the base. @pre the body is a link
  int linkNumber() const { return static_cast<int>(link->link) - 1; }
};

/// Makes a rigid body that never falls asleep; adds it to no world and no fluid.
WorldBody makeWorldBody(const BodyDef& def, const PreparedBody& prepared);
/// Describes a link of a robot, which has its shape and its Bullet body.
WorldBody makeWorldLink(const BodyDef& def, const PreparedBody& prepared, const Matrix3& R_SB);

/// Bullet's world and solver of a scene: a btMultiBodyDynamicsWorld if it takes robots.
struct BulletWorld {
  std::unique_ptr<btConstraintSolver> solver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  btMultiBodyDynamicsWorld* multi_body_world = nullptr;  ///< the world; null: it takes no robots
};

BulletWorld makeBulletWorld(bool takes_robots, btCollisionDispatcher& dispatcher,
                            btBroadphaseInterface& broadphase,
                            btCollisionConfiguration& configuration);

}  // namespace ambient
