#include "preprocess/robot/robot.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/resistance/prepare.h"

AMBIENT_BEGIN
namespace {

/// Share of the error of a mimic that a step takes back.
constexpr btScalar kMimicErp = btScalar(0.2);

btScalar boundedImpulse(double impulse) {
  return static_cast<btScalar>(std::min(impulse, static_cast<double>(BT_LARGE_FLOAT)));
}

}  // namespace

RobotJoints::RobotJoints(const RobotModel& model, btMultiBody& body) : model_(model), body_(body) {
  for (int number = 0; number < body.getNumLinks(); ++number) {
    const JointModel& of = joint(number);
    if (!of.isAxial()) continue;
    if (std::isfinite(of.lower)) makeLimit(number, of);
    if (of.mimic) makeMimic(number, *of.mimic);
    if (of.friction > 0 || of.damping > 0) brakes_[number] = makeMotor(number);
  }
}

void RobotJoints::makeLimit(int number, const JointModel& of) {
  passive_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(
      &body_, number, static_cast<btScalar>(of.lower), static_cast<btScalar>(of.upper)));
  passive_.back()->setMaxAppliedImpulse(BT_LARGE_FLOAT);
  passive_.back()->finalizeMultiDof();
}

void RobotJoints::makeMimic(int number, const JointModel::Mimic& mimic) {
  const int leader = model_.jointIndex(mimic.joint) - 1;
  const btVector3 none(0, 0, 0);
  const btMatrix3x3 axes = btMatrix3x3::getIdentity();
  auto gear = std::make_unique<btMultiBodyGearConstraint>(&body_, number, &body_, leader, none,
                                                          none, axes, axes);
  gear->setGearRatio(static_cast<btScalar>(-mimic.multiplier));
  gear->setRelativePositionTarget(static_cast<btScalar>(mimic.offset));
  gear->setErp(kMimicErp);
  gear->setMaxAppliedImpulse(BT_LARGE_FLOAT);
  gear->finalizeMultiDof();
  passive_.push_back(std::move(gear));
}

std::unique_ptr<btMultiBodyJointMotor> RobotJoints::makeMotor(int number) {
  auto motor = std::make_unique<btMultiBodyJointMotor>(&body_, number, btScalar(0), btScalar(0));
  motor->finalizeMultiDof();
  return motor;
}

const JointModel& RobotJoints::joint(int number) const {
  return model_.links[static_cast<std::size_t>(number) + 1].joint;
}

std::vector<btMultiBodyConstraint*> RobotJoints::all() const {
  std::vector<btMultiBodyConstraint*> constraints;
  for (const auto& constraint : passive_) constraints.push_back(constraint.get());
  for (const auto& [number, brake] : brakes_) constraints.push_back(brake.get());
  for (const auto& [number, motor] : motors_) constraints.push_back(motor.constraint.get());
  return constraints;
}

void RobotJoints::addTo(btMultiBodyDynamicsWorld& world) {
  world_ = &world;
  for (btMultiBodyConstraint* constraint : all()) world.addMultiBodyConstraint(constraint);
}

void RobotJoints::leaveWorld() {
  if (!world_) return;
  for (btMultiBodyConstraint* constraint : all()) world_->removeMultiBodyConstraint(constraint);
  world_ = nullptr;
}

void RobotJoints::setMotor(int number, const MotorTarget& target) {
  Motor& motor = motors_[number];
  if (!motor.constraint) {
    motor.constraint = makeMotor(number);
    if (world_) world_->addMultiBodyConstraint(motor.constraint.get());
  }
  const JointModel& of = joint(number);
  motor.effort = std::min(target.effort, of.effort);
  motor.constraint->setPositionTarget(static_cast<btScalar>(target.position),
                                      static_cast<btScalar>(target.position_gain));
  motor.constraint->setVelocityTarget(static_cast<btScalar>(target.velocity),
                                      static_cast<btScalar>(target.velocity_gain));
  motor.constraint->setRhsClamp(boundedImpulse(of.velocity));
}

// A motor without effort has no row, and keeps the impulse of the last row that it had.
double RobotJoints::motorEffort(int number) const {
  const auto motor = motors_.find(number);
  if (motor == motors_.end() || !(motor->second.effort > 0) || time_step_ == 0) return 0;
  return static_cast<double>(motor->second.constraint->getAppliedImpulse(0)) / time_step_;
}

void RobotJoints::prepareStep(double time_step) {
  time_step_ = time_step;
  for (const auto& [number, brake] : brakes_) {
    const double speed = std::abs(static_cast<double>(body_.getJointVel(number)));
    const JointModel& of = joint(number);
    brake->setMaxAppliedImpulse(boundedImpulse((of.friction + of.damping * speed) * time_step));
  }
  for (auto& [number, motor] : motors_)
    motor.constraint->setMaxAppliedImpulse(boundedImpulse(motor.effort * time_step));
}

Robot::Robot(RobotModel model, const RobotSettings& settings)
    : model_(withCarriedCollisions(std::move(model), settings.fixed_base)) {
  checkRobot(model_, settings.fixed_base);
  for (const LinkModel& link : model_.links) {
    frames_.push_back(findMassFrame(link));
    shapes_.push_back(makeLinkShape(link, frames_.back().link_in_body));
  }
  for (LinkShape& shape : shapes_)
    std::move(shape.warnings.begin(), shape.warnings.end(), std::back_inserter(model_.warnings));
  makeBody(settings);
  makeColliders();
  setPose(settings.pose);
  setTwist(settings.twist_W);
  for (const auto& [joint, position] : settings.positions) setPosition(joint, position);
  for (const auto& [joint, velocity] : settings.velocities) setVelocity(joint, velocity);
  joints_ = std::make_unique<RobotJoints>(model_, *body_);
}

Robot::~Robot() { leaveWorld(); }

void Robot::makeBody(const RobotSettings& settings) {
  const LinkModel& base = model_.links.front();
  body_ = std::make_unique<btMultiBody>(
      static_cast<int>(model_.links.size()) - 1, static_cast<btScalar>(base.mass),
      toBullet(frames_.front().moments), settings.fixed_base, settings.can_sleep);
  for (std::size_t i = 1; i < model_.links.size(); ++i) setUpLink(i);
  body_->finalizeMultiDof();
  body_->setHasSelfCollision(settings.self_collision);
  body_->setLinearDamping(0);
  body_->setAngularDamping(0);
  body_->setMaxCoordinateVelocity(std::numeric_limits<btScalar>::max());
}

void Robot::setUpLink(std::size_t index) {
  const LinkModel& link = model_.links[index];
  const RigidPose& in_parent = frames_[static_cast<std::size_t>(link.parent)].link_in_body;
  const RigidPose& in_body = frames_[index].link_in_body;
  // B of the parent and the joint's frame meet in the pivot; all is given in these axes of B.
  const RigidPose joint_in_parent = in_parent * link.joint.origin;
  const int number = static_cast<int>(index) - 1, parent = link.parent - 1;
  const btScalar mass = static_cast<btScalar>(link.mass);
  const btVector3 moments = toBullet(frames_[index].moments);
  const btQuaternion turn = toBullet(
      Quaternion(Matrix3(in_body.linear() * joint_in_parent.linear().transpose())).normalized());
  const btVector3 axis = toBullet(Vector3(in_body.linear() * link.joint.axis));
  const btVector3 pivot = toBullet(Vector3(joint_in_parent.translation()));
  const btVector3 arm = toBullet(Vector3(-in_body.translation()));
  constexpr bool kNoParentCollision = true;
  switch (link.joint.kind) {
    case UrdfJointKind::kRevolute:
      body_->setupRevolute(number, mass, moments, parent, turn, axis, pivot, arm,
                           kNoParentCollision);
      break;
    case UrdfJointKind::kPrismatic:
      body_->setupPrismatic(number, mass, moments, parent, turn, axis, pivot, arm,
                            kNoParentCollision);
      break;
    case UrdfJointKind::kPlanar: {
      // Bullet turns the link about its centre of mass; motions in the plane are the same.
      const Vector3 centre = joint_in_parent * link.centre_of_mass;
      body_->setupPlanar(number, mass, moments, parent, turn, axis, toBullet(centre),
                         kNoParentCollision);
      break;
    }
    default:
      body_->setupFixed(number, mass, moments, parent, turn, pivot, arm);
  }
}

void Robot::makeColliders() {
  for (int number = -1; number < body_->getNumLinks(); ++number) {
    // Bullet knows motors and limits of links with colliders only: all have one.
    auto collider = std::make_unique<btMultiBodyLinkCollider>(body_.get(), number);
    collider->setCollisionShape(shapes_[indexOf(number)].in_body.get());
    if (number < 0) {
      if (body_->hasFixedBase()) collider->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
      body_->setBaseCollider(collider.get());
    } else {
      body_->getLink(number).m_collider = collider.get();
    }
    if (!body_->getCanSleep()) collider->setActivationState(DISABLE_DEACTIVATION);
    colliders_.push_back(std::move(collider));
  }
}

void Robot::setPose(const RigidPose& pose) {
  if (!pose.matrix().allFinite())
    raiseInputError(model_.source, "the pose of the robot is not finite");
  const RigidPose base = pose * model_.links.front().joint.origin * linkInBody(-1).inverse();
  body_->setBaseWorldTransform(toBulletTransform(base));
  moveColliders();
}

void Robot::setTwist(const Twist& twist_W) {
  if (!twist_W.vector().allFinite())
    raiseInputError(model_.source, "the velocity of the robot is not finite");
  if (body_->hasFixedBase() && !twist_W.vector().isZero(0))
    raiseInputError(model_.source,
                    "the robot has a velocity and a fixed base; must have one of them");
  body_->setBaseVel(toBullet(twist_W.linear));
  body_->setBaseOmega(toBullet(twist_W.angular));
}

void Robot::requireFinite(const std::string& joint, const char* what, double value) const {
  requireAxial(joint);
  if (!std::isfinite(value))
    raiseInputError(model_.source, "the ", what, " of joint \"", joint, "\" is not finite");
}

void Robot::setPosition(const std::string& joint, double position) {
  requireFinite(joint, "position", position);
  body_->setJointPos(jointNumber(joint), static_cast<btScalar>(position));
  settleLink(body_->getLink(jointNumber(joint)));
  moveColliders();
}

void Robot::setVelocity(const std::string& joint, double velocity) {
  requireFinite(joint, "velocity", velocity);
  body_->setJointVel(jointNumber(joint), static_cast<btScalar>(velocity));
}

void Robot::moveColliders() {
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> places;
  body_->forwardKinematics(turns, places);
  body_->updateCollisionObjectWorldTransforms(turns, places);
}

void Robot::addTo(btMultiBodyDynamicsWorld& world) {
  world_ = &world;
  world.addMultiBody(body_.get());
  using Filter = btBroadphaseProxy;
  for (const auto& collider : colliders_) {
    const auto* shape = static_cast<const btCompoundShape*>(collider->getCollisionShape());
    const bool is_static = collider->isStaticObject();
    const int group = is_static ? Filter::StaticFilter : Filter::DefaultFilter;
    const int mask = is_static ? Filter::AllFilter ^ Filter::StaticFilter : Filter::AllFilter;
    world.addCollisionObject(collider.get(), group, shape->getNumChildShapes() > 0 ? mask : 0);
  }
  joints_->addTo(world);
}

void Robot::leaveWorld() {
  if (!world_) return;
  joints_->leaveWorld();
  for (const auto& collider : colliders_) world_->removeCollisionObject(collider.get());
  world_->removeMultiBody(body_.get());
  world_ = nullptr;
}

const btTransform& Robot::bodyTransform(int number) const {
  return colliders_.at(indexOf(number))->getWorldTransform();
}

RigidPose Robot::linkPose(int number) const {
  return toPose(bodyTransform(number)) * linkInBody(number);
}

RigidPose Robot::linkPose(const std::string& name) const {
  const int number = linkNumber(name);
  const RigidPose pose = linkPose(number);
  return link(number).name == name ? pose : pose * link(number).merged.at(name);
}

void Robot::requireAxial(const std::string& joint) const {
  if (!link(jointNumber(joint)).joint.isAxial())
    raiseInputError(model_.source, "joint \"", joint, "\": it must be revolute or prismatic");
}

double Robot::position(const std::string& joint) const {
  requireAxial(joint);
  return static_cast<double>(body_->getJointPos(jointNumber(joint)));
}

double Robot::velocity(const std::string& joint) const {
  requireAxial(joint);
  return static_cast<double>(body_->getJointVel(jointNumber(joint)));
}

double Robot::motorEffort(const std::string& joint) const {
  requireAxial(joint);
  return joints_->motorEffort(jointNumber(joint));
}

void Robot::setMotor(const std::string& joint, const MotorTarget& target) {
  requireAxial(joint);
  if (!std::isfinite(target.position) || !std::isfinite(target.velocity) ||
      !std::isfinite(target.position_gain) || !std::isfinite(target.velocity_gain) ||
      !(target.effort >= 0))
    raiseInputError(model_.source, "the motor of joint \"", joint,
                    "\": its targets and gains must be finite, its effort >= 0");
  joints_->setMotor(jointNumber(joint), target);
  body_->wakeUp();
}

void Robot::prepareStep(double time_step) { joints_->prepareStep(time_step); }

namespace {

AttachDef linkDef(const Robot& robot, int number, FluidBodySource& source, AttachDef def) {
  const std::optional<LinkFluid>& own = robot.link(number).fluid;
  if (own && own->medium == "water") def.medium = water();
  if (own && own->medium == "air") def.medium = air();
  if (own && own->law) def.flow.law = *own->law;
  if (own && own->roughness) def.flow.roughness = *own->roughness;
  def.fluid_body = own && !own->fluid_body.empty()
                       ? std::make_shared<const FluidBody>(readPrepared(own->fluid_body.string()))
                       : source.fluidBody(*robot.shape(number).in_link);
  def.fluid_frame = linkFluidFrame(robot, number);
  return def;
}

bool meetsFluid(const Robot& robot, int number) {
  const LinkModel& link = robot.link(number);
  const bool moves = number >= 0 || !robot.multiBody().hasFixedBase();
  return moves && !robot.shape(number).isEmpty() && (!link.fluid || link.fluid->medium != "none");
}

FluidBodySource::Expected shapesToMake(const Robot& robot) {
  FluidBodySource::Expected expected;
  std::vector<std::string> names;
  for (int number = -1; number < robot.multiBody().getNumLinks(); ++number) {
    const LinkModel& link = robot.link(number);
    if (!meetsFluid(robot, number) || (link.fluid && !link.fluid->fluid_body.empty())) continue;
    expected.shapes.push_back(robot.shape(number).in_link.get());
    names.push_back("link '" + link.name + "'");
  }
  expected.whose = [names](std::size_t k) { return names[k]; };
  return expected;
}

}  // namespace

std::vector<std::string> attachRobot(Fluid& fluid, Robot& robot, FluidBodySource& source,
                                     const AttachDef& def) {
  btMultiBody& body = robot.multiBody();
  std::vector<Immersed> links;
  std::vector<std::string> attached;
  const FluidBodySource::Expected expected = shapesToMake(robot);
  const Expecting expecting(source, expected);
  for (int number = -1; number < body.getNumLinks(); ++number) {
    if (!meetsFluid(robot, number)) continue;
    try {
      links.push_back(fluid.add(body, number, linkDef(robot, number, source, def)));
    } catch (const std::exception& error) {
      for (Immersed& link : links) link.remove();
      raiseInputError(robot.model().source, "link \"", robot.link(number).name,
                      "\": ", error.what());
    }
    attached.push_back(robot.link(number).name);
  }
  return attached;
}

FrameOffset linkFluidFrame(const Robot& robot, int number) {
  const RigidPose& pose = robot.linkInBody(number);
  return {Matrix3(pose.linear()), Vector3(pose.translation())};
}

AMBIENT_END
