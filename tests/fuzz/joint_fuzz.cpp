#include "tests/fuzz/fuzz_scene.h"

namespace ambient::test {
namespace {

// Joint frames that fit the present poses of the bodies.
struct JointFrames {
  btTransform in_a, in_b;

  JointFrames(const btRigidBody& a, const btRigidBody& b) {
    btTransform middle(a.getWorldTransform());
    middle.setOrigin((a.getWorldTransform().getOrigin() + b.getWorldTransform().getOrigin()) / 2);
    in_a = a.getWorldTransform().inverse() * middle;
    in_b = b.getWorldTransform().inverse() * middle;
  }
};

std::unique_ptr<btTypedConstraint> makeJoint(int kind, btRigidBody& a, btRigidBody& b) {
  const JointFrames frames(a, b);
  switch (kind) {
    case 0:
      return std::make_unique<btPoint2PointConstraint>(a, b, frames.in_a.getOrigin(),
                                                       frames.in_b.getOrigin());
    case 1: {
      auto hinge = std::make_unique<btHingeConstraint>(a, b, frames.in_a, frames.in_b);
      hinge->enableAngularMotor(true, 2, 5);
      hinge->setLimit(btScalar(-0.5), btScalar(0.5));
      return hinge;
    }
    case 2: {
      auto slider = std::make_unique<btSliderConstraint>(a, b, frames.in_a, frames.in_b, true);
      slider->setLowerLinLimit(btScalar(-0.2));
      slider->setUpperLinLimit(btScalar(0.2));
      return slider;
    }
    case 3:
      return std::make_unique<btConeTwistConstraint>(a, b, frames.in_a, frames.in_b);
    case 4: {
      auto spring =
          std::make_unique<btGeneric6DofSpring2Constraint>(a, b, frames.in_a, frames.in_b);
      spring->setLinearLowerLimit(btVector3(-1, -1, -1));
      spring->setLinearUpperLimit(btVector3(1, 1, 1));
      spring->enableSpring(0, true);
      spring->setStiffness(0, 50);
      spring->setDamping(0, 1);
      return spring;
    }
    default:
      return std::make_unique<btFixedConstraint>(a, b, frames.in_a, frames.in_b);
  }
}

}  // namespace

void FuzzScene::addJoint() {
  FuzzBody* a = anyBody();
  FuzzBody* b = anyBody();
  if (!a || a == b || !a->is_in_world || !b->is_in_world || joints_.size() >= 12) return;
  btRigidBody& other = chance(0.2) ? *floor_ : *b->body;
  if (a->body->getInvMass() == 0 && other.getInvMass() == 0) return;
  const btVector3 distance = a->body->getCenterOfMassPosition() - other.getCenterOfMassPosition();
  if (distance.length() > btScalar(1.5))
    return;  // long levers on light bodies gain speed in stock Bullet
  joints_.push_back(makeJoint(below(6), *a->body, other));
  if (chance(0.2)) joints_.back()->setBreakingImpulseThreshold(5);
  world_.addConstraint(joints_.back().get(), chance(0.7));
}

void FuzzScene::removeJoint() {
  if (joints_.empty()) return;
  world_.removeConstraint(joints_.back().get());
  joints_.pop_back();
}

void FuzzScene::removeJointsOf(const btRigidBody& body) {
  for (std::size_t i = joints_.size(); i-- > 0;) {
    btTypedConstraint& joint = *joints_[i];
    if (&joint.getRigidBodyA() != &body && &joint.getRigidBodyB() != &body) continue;
    world_.removeConstraint(&joint);
    joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace ambient::test
