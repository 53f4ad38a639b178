#include "demos/simulation/world_body.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/principal_frame.h"

namespace ambient {
namespace {

MotionSample startOf(const BodyDef& def) {
  MotionSample start;
  start.position = def.position;
  start.orientation = def.orientation;
  start.twist = {def.angular_velocity, def.linear_velocity};
  return start;
}

btTransform toBulletPose(const Matrix3& rotation, const Vector3& translation) {
  return btTransform(toBulletMatrix(rotation), toBullet(translation));
}

}  // namespace

WorldBody makeWorldBody(const BodyDef& def, const PreparedBody& prepared) {
  WorldBody made;
  made.name = def.name;
  made.fluid_body = prepared.fluid_body;
  made.start = startOf(def);
  PrincipalFrame principal;
  if (prepared.mass > 0) principal = findPrincipalFrame(prepared.inertia);
  made.R_SB = principal.rotation;
  const Matrix3 R_BS = made.R_SB.transpose();
  made.shape = makeCollisionShape(def, prepared,
                                  toBulletPose(R_BS, Vector3(R_BS * -prepared.centre_of_mass)));

  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(prepared.mass), nullptr,
                                                made.shape.root(), toBullet(principal.moments));
  info.m_startWorldTransform =
      toBulletPose(Matrix3(def.orientation.toRotationMatrix() * made.R_SB), def.position);
  info.m_restitution = static_cast<btScalar>(def.restitution);
  info.m_friction = static_cast<btScalar>(def.friction);
  made.body = std::make_unique<btRigidBody>(info);
  made.body->setLinearVelocity(toBullet(def.linear_velocity));
  made.body->setAngularVelocity(toBullet(def.angular_velocity));
  // Bullet would put a body that hovers or glides slowly to sleep.
  made.body->setActivationState(DISABLE_DEACTIVATION);
  return made;
}

WorldBody makeWorldLink(const BodyDef& def, const PreparedBody& prepared, const Matrix3& R_SB) {
  WorldBody made;
  made.name = def.name;
  made.link = def.link;
  made.fluid_body = prepared.fluid_body;
  made.start = startOf(def);
  made.R_SB = R_SB;
  return made;
}

BulletWorld makeBulletWorld(bool takes_robots, btCollisionDispatcher& dispatcher,
                            btBroadphaseInterface& broadphase,
                            btCollisionConfiguration& configuration) {
  BulletWorld made;
  if (takes_robots) {
    auto solver = std::make_unique<btMultiBodyConstraintSolver>();
    auto world = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher, &broadphase, solver.get(),
                                                            &configuration);
    made.multi_body_world = world.get();
    made.solver = std::move(solver);
    made.world = std::move(world);
  } else {
    auto solver = std::make_unique<btSequentialImpulseConstraintSolver>();
    made.world = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, solver.get(),
                                                           &configuration);
    made.solver = std::move(solver);
  }
  // Contacts, and so their rounding, then depend on the state alone and not on its history.
  made.world->getDispatchInfo().m_deterministicOverlappingPairs = true;
  return made;
}

}  // namespace ambient
