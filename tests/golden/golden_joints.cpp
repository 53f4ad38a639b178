// Bodies in water on each kind of Bullet's joints: to the world, to each other, to a dry body.

#include "tests/golden/golden_world.h"

namespace ambient::test {
namespace {

using MakeJoint = std::function<btTypedConstraint*(btRigidBody& a, btRigidBody& b)>;

btTransform frame(double x) {
  return btTransform(btQuaternion(bt(0.2), bt(0.1), 0, 1).normalized(), {bt(x), 0, 0});
}

GoldenRecord swing(const MakeJoint& make) {
  GoldenWorld world;
  for (int i = 0; i < 4; ++i) {
    GoldenBody body;
    body.position = {0.6 * i, 0, 3};
    body.twist = {{0, 0.5 * i, 1}, {0, 0.1, 0.2}};
    body.mass = 20;
    body.moments = {0.4, 0.5, 0.6};
    if (i == 3)
      world.addDry(body);
    else
      world.add(body, i == 1 ? symmetricInWater() : bumpyInWater());
  }
  world.addJoint(make(world.body(0), btTypedConstraint::getFixedBody()));
  btJointFeedback feedback{};
  world.addJoint(make(world.body(1), world.body(0))).setJointFeedback(&feedback);
  world.addJoint(make(world.body(1), world.body(2)));
  world.addJoint(make(world.body(3), world.body(2)));
  return world.run(120, [&](int step) {
    if (step == 60) world.body(2).applyCentralForce(feedback.m_appliedForceBodyA);
  });
}

// Frame of a joint in b's axes that coincides with `in_a` in a's axes.
btTransform seenFrom(const btRigidBody& b, const btRigidBody& a, const btTransform& in_a) {
  return b.getWorldTransform().inverse() * a.getWorldTransform() * in_a;
}

btTypedConstraint* makeBall(btRigidBody& a, btRigidBody& b) {
  const btTransform at = frame(-0.3);
  return new btPoint2PointConstraint(a, b, at.getOrigin(), seenFrom(b, a, at).getOrigin());
}

btTypedConstraint* makeHinge(btRigidBody& a, btRigidBody& b) {
  auto* hinge = new btHingeConstraint(a, b, frame(-0.3), seenFrom(b, a, frame(-0.3)));
  hinge->enableAngularMotor(true, 2, bt(0.5));
  hinge->setLimit(bt(-0.2), bt(0.3));
  return hinge;
}

btTypedConstraint* makeSlider(btRigidBody& a, btRigidBody& b) {
  auto* slider = new btSliderConstraint(a, b, frame(0), seenFrom(b, a, frame(0)), true);
  slider->setLowerLinLimit(bt(-0.05));
  slider->setUpperLinLimit(bt(0.1));
  return slider;
}

btTypedConstraint* makeConeTwist(btRigidBody& a, btRigidBody& b) {
  auto* cone = new btConeTwistConstraint(a, b, frame(-0.3), seenFrom(b, a, frame(-0.3)));
  cone->setLimit(bt(0.3), bt(0.2), bt(0.1));
  return cone;
}

btTypedConstraint* makeFixed(btRigidBody& a, btRigidBody& b) {
  return new btFixedConstraint(a, b, frame(0), seenFrom(b, a, frame(0)));
}

btTypedConstraint* makeSpring(btRigidBody& a, btRigidBody& b) {
  auto* spring = new btGeneric6DofSpring2Constraint(a, b, frame(0), seenFrom(b, a, frame(0)));
  for (int axis = 0; axis < 6; ++axis) {
    spring->setLimit(axis, bt(-0.2), bt(0.2));
    spring->enableSpring(axis, true);
    spring->setStiffness(axis, bt(400));
    spring->setDamping(axis, bt(3));
  }
  return spring;
}

}  // namespace

std::vector<GoldenRun> goldenJoints() {
  std::vector<GoldenRun> runs;
  const std::vector<std::pair<std::string, MakeJoint>> joints = {
      {"ball", makeBall},     {"hinge", makeHinge},
      {"slider", makeSlider}, {"cone_twist", makeConeTwist},
      {"fixed", makeFixed},   {"spring", makeSpring}};
  for (const auto& [name, make] : joints)
    runs.push_back({"joint_" + name, [make = make] { return swing(make); }});
  return runs;
}

}  // namespace ambient::test
