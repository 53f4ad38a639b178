#include "bullet_ambient/bullet/core/body_motion.h"

#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

RigidState stateOf(const btTransform& pose, const Twist& twist_W) {
  RigidState state;
  state.orientation = toQuaternion(pose.getRotation());
  state.position = toVector3(pose.getOrigin());
  state.twist = turned(state.orientation.conjugate(), twist_W);
  return state;
}

}  // namespace

RigidState readState(const btRigidBody& body) {
  return stateOf(body.getWorldTransform(), velocityOf(body));
}

AxisFactors axisFactors(const btRigidBody& body) {
  return {toVector3(body.getAngularFactor()), toVector3(body.getLinearFactor())};
}

void setMotion(const btTransform& pose, const Twist& twist_W, MotionView& view) {
  view.state = stateOf(pose, twist_W);
  view.twist_W = twist_W;
  view.rounding = kBulletRounding;
}

MotionView motionOf(const btRigidBody& body) {
  MotionView view;
  setMotion(body.getWorldTransform(), velocityOf(body), view);
  view.gravity = toVector3(body.getGravity());
  return view;
}

Surroundings readSurroundings(const AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  Surroundings surroundings =
      surroundingsOf(ambient, toVector3(body.getGravity()),
                     {toVector3(body.getTotalTorque()), toVector3(body.getTotalForce())});
  if (hasFlowAlong(ambient))
    addFlowAlong(ambient, toQuaternion(body.getWorldTransform().getRotation()), surroundings);
  return surroundings;
}

AMBIENT_END
