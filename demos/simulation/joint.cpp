#include "demos/simulation/joint.h"

#include "bullet_ambient/bullet/conversions.h"

namespace ambient {
namespace {

/// A joint's place and direction in the frame of one body.
struct JointEnd {
  btVector3 point, axis;

  JointEnd(const JointDef& joint, const btRigidBody& body) {
    const btTransform to_body = body.getWorldTransform().inverse();
    point = to_body * toBullet(joint.point);
    if (joint.axis) axis = to_body.getBasis() * toBullet(joint.axis->normalized());
  }
};

}  // namespace

std::unique_ptr<btTypedConstraint> makeJoint(const JointDef& joint, btRigidBody& first,
                                             btRigidBody* second) {
  const JointEnd a(joint, first);
  if (!second) {
    if (!joint.axis) return std::make_unique<btPoint2PointConstraint>(first, a.point);
    return std::make_unique<btHingeConstraint>(first, a.point, a.axis);
  }
  const JointEnd b(joint, *second);
  if (!joint.axis)
    return std::make_unique<btPoint2PointConstraint>(first, *second, a.point, b.point);
  return std::make_unique<btHingeConstraint>(first, *second, a.point, b.point, a.axis, b.axis);
}

}  // namespace ambient
