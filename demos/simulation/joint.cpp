#include "demos/simulation/joint.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/bullet/core/conversions.h"

namespace ambient {
namespace {

/// Throws if the point is more than 2^23 body sizes away: the limit of makeBodyModel().
void checkPoint(const JointDef& joint, const std::string& name, const btRigidBody& body) {
  constexpr double kSizes = 8388608;
  const double lever =
      static_cast<double>((toBullet(joint.point) - body.getWorldTransform().getOrigin()).length());
  const Vector3 moments = toVector3(body.getInvInertiaDiagLocal()).cwiseInverse();
  const double size = std::sqrt(moments.maxCoeff() * static_cast<double>(body.getInvMass()));
  if (body.getInvMass() == 0 || lever <= kSizes * size) return;
  std::ostringstream text;
  text << "joint of body \"" << name << "\": its point is " << lever
       << " m from the centre of mass; must be at most 2^23 times the radius of gyration, " << size
       << " m";
  throw std::invalid_argument(text.str());
}

/// Point and axis of a joint in the frame of one body.
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
  checkPoint(joint, joint.bodies[0], first);
  if (second) checkPoint(joint, joint.bodies[1], *second);
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
