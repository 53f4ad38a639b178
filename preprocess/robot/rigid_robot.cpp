#include "preprocess/robot/rigid_robot.h"

#include <BulletDynamics/ConstraintSolver/btFixedConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/spatial/rotation.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

/// Axes of a constraint in the joint's: one of them, the hinge's z or the slider's x, along `axis`.
RigidPose constraintAxes(const Vector3& along, const Vector3& axis) {
  RigidPose pose = RigidPose::Identity();
  pose.linear() = rotationBetween(along, axis).toRotationMatrix();
  return pose;
}

void requireRigid(const RobotModel& model, bool fixed_base) {
  for (const LinkModel& link : model.links) {
    if (link.joint.kind == JointKind::kPlanar)
      raiseInputError(model.source, "joint \"", link.joint.name,
                      "\": it is planar; between rigid bodies it must be fixed, revolute or "
                      "prismatic");
    if (!(link.mass > 0) && !(fixed_base && link.parent < 0))
      raiseInputError(model.source, "link \"", link.name, "\": its mass is ", link.mass,
                      " kg; must be > 0, or the link be merged into its parent");
  }
}

btScalar limit(double value) { return static_cast<btScalar>(value); }

}  // namespace

RigidRobot::RigidRobot(RobotModel model, const RobotSettings& settings) : model_(std::move(model)) {
  checkRobot(model_, settings.fixed_base);
  requireRigid(model_, settings.fixed_base);
  for (const auto& [joint, position] : settings.positions) jointIndex(joint);
  const std::vector<RigidPose> poses = linkPoses(model_, settings.pose, settings.positions);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].matrix().allFinite())
      raiseInputError(model_.source, "the pose of link \"", model_.links[i].name,
                      "\" is not finite");
    makeBody(i, poses[i], settings);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) joints_.push_back(makeJoint(i));
}

RigidRobot::~RigidRobot() { leaveWorld(); }

void RigidRobot::makeBody(std::size_t index, const RigidPose& pose, const RobotSettings& settings) {
  const LinkModel& link = model_.links[index];
  frames_.push_back(findMassFrame(link));
  const LinkMassFrame& frame = frames_.back();
  shapes_.push_back(makeLinkShape(link, frame.link_in_body));
  const bool is_static = settings.fixed_base && link.parent < 0;
  btRigidBody::btRigidBodyConstructionInfo info(
      is_static ? btScalar(0) : static_cast<btScalar>(link.mass), nullptr,
      shapes_.back().in_body.get(), is_static ? btVector3(0, 0, 0) : toBullet(frame.moments));
  info.m_startWorldTransform = toBulletTransform(pose * frame.link_in_body.inverse());
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  if (!settings.can_sleep) bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
}

std::unique_ptr<btTypedConstraint> RigidRobot::makeJoint(std::size_t index) const {
  const LinkModel& link = model_.links[index];
  if (link.parent < 0) return nullptr;
  const JointModel& of = link.joint;
  const std::size_t above = static_cast<std::size_t>(link.parent);
  const RigidPose in_parent = frames_[above].link_in_body * of.origin;
  const RigidPose in_child = frames_[index].link_in_body;
  btRigidBody &parent = *bodies_[above], &child = *bodies_[index];
  constexpr bool kSeenFromParent = true;
  if (of.kind == JointKind::kFixed)
    return std::make_unique<btFixedConstraint>(parent, child, toBulletTransform(in_parent),
                                               toBulletTransform(in_child));
  const bool turns = of.kind == JointKind::kRevolute;
  const RigidPose axes = constraintAxes(turns ? Vector3::UnitZ() : Vector3::UnitX(), of.axis);
  const btTransform a = toBulletTransform(in_parent * axes);
  const btTransform b = toBulletTransform(in_child * axes);
  if (turns) {
    auto hinge = std::make_unique<btHingeConstraint>(parent, child, a, b, kSeenFromParent);
    if (std::isfinite(of.lower)) hinge->setLimit(limit(of.lower), limit(of.upper));
    return hinge;
  }
  auto slider = std::make_unique<btSliderConstraint>(parent, child, a, b, kSeenFromParent);
  slider->setLowerAngLimit(0);
  slider->setUpperAngLimit(0);
  slider->setLowerLinLimit(limit(of.lower));
  slider->setUpperLinLimit(limit(of.upper));
  return slider;
}

void RigidRobot::addTo(btDynamicsWorld& world) {
  world_ = &world;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (shapes_[i].isEmpty())
      world.addRigidBody(bodies_[i].get(), btBroadphaseProxy::DefaultFilter, 0);
    else
      world.addRigidBody(bodies_[i].get());
  }
  constexpr bool kWithoutCollisions = true;
  for (const auto& joint : joints_)
    if (joint) world.addConstraint(joint.get(), kWithoutCollisions);
}

void RigidRobot::leaveWorld() {
  if (!world_) return;
  for (const auto& joint : joints_)
    if (joint) world_->removeConstraint(joint.get());
  for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  world_ = nullptr;
}

btRigidBody& RigidRobot::body(const std::string& link) const { return *bodies_[linkIndex(link)]; }

btTypedConstraint& RigidRobot::joint(const std::string& joint) const {
  return *joints_[jointIndex(joint)];
}

const LinkShape& RigidRobot::shape(const std::string& link) const {
  return shapes_[linkIndex(link)];
}

const RigidPose& RigidRobot::linkInBody(const std::string& link) const {
  return frames_[linkIndex(link)].link_in_body;
}

double RigidRobot::position(const std::string& name) const {
  btTypedConstraint& of = joint(name);
  if (of.getConstraintType() == HINGE_CONSTRAINT_TYPE)
    return static_cast<double>(static_cast<btHingeConstraint&>(of).getHingeAngle());
  if (of.getConstraintType() != SLIDER_CONSTRAINT_TYPE)
    raiseInputError(model_.source, "joint \"", name, "\": it must be revolute or prismatic");
  auto& slider = static_cast<btSliderConstraint&>(of);
  slider.calculateTransforms(slider.getRigidBodyA().getCenterOfMassTransform(),
                             slider.getRigidBodyB().getCenterOfMassTransform());
  slider.testLinLimits();
  return static_cast<double>(slider.getLinearPos());
}

void RigidRobot::setVelocity(const std::string& name, double velocity, double effort,
                             double time_step) {
  const JointModel& model = model_.links[jointIndex(name)].joint;
  const double most = std::min(effort, model.effort);
  const double bounded = std::max(-model.velocity, std::min(model.velocity, velocity));
  const bool drives = most > 0;
  btTypedConstraint& of = joint(name);
  if (of.getConstraintType() == HINGE_CONSTRAINT_TYPE) {
    static_cast<btHingeConstraint&>(of).enableAngularMotor(drives, limit(bounded),
                                                           limit(most * time_step));
  } else if (of.getConstraintType() == SLIDER_CONSTRAINT_TYPE) {
    auto& slider = static_cast<btSliderConstraint&>(of);
    slider.setPoweredLinMotor(drives);
    slider.setTargetLinMotorVelocity(limit(bounded));
    slider.setMaxLinMotorForce(limit(most));
  } else {
    raiseInputError(model_.source, "joint \"", name, "\": it must be revolute or prismatic");
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
