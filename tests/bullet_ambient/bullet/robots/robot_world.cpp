#include "tests/bullet_ambient/bullet/robots/robot_world.h"

#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>

#include <utility>

#include "bullet_ambient/bullet/members/tree_state.h"
#include "tests/support/bodies/free_body.h"

namespace ambient::test {
namespace {

btVector3 direction(Arbitrary& arbitrary) { return toBullet(arbitrary.vector().normalized()); }

btQuaternion arbitraryTurn(Arbitrary& arbitrary) {
  return toBullet(Quaternion(arbitrary.rotation()));
}

JointKind kindOf(Joints joints, int link) {
  constexpr JointKind kInTurn[] = {JointKind::kRevolute, JointKind::kPrismatic,
                                   JointKind::kSpherical, JointKind::kFixed, JointKind::kPlanar};
  if (joints == Joints::kRevolute) return JointKind::kRevolute;
  return kInTurn[link % (joints == Joints::kAll ? 5 : 4)];
}

void setupLink(Arbitrary& arbitrary, btMultiBody& body, int link, Joints joints) {
  const btScalar mass = bt(arbitrary.between(0.3, 1.3));
  const btVector3 inertia =
      mass * btVector3(bt(arbitrary.between(0.008, 0.012)), bt(arbitrary.between(0.008, 0.012)),
                       bt(arbitrary.between(0.008, 0.012)));
  const bool is_tree = joints != Joints::kRevolute && link > 2;
  const int parent = is_tree ? static_cast<int>(arbitrary.between(0, link)) - 1 : link - 1;
  const btQuaternion turn = arbitraryTurn(arbitrary);
  const btVector3 axis = direction(arbitrary);
  const btVector3 to_pivot(bt(0.15), bt(arbitrary.between(-0.03, 0.03)), bt(0.02));
  const btVector3 to_link(bt(0.15), bt(0.01), bt(arbitrary.between(-0.03, 0.03)));
  switch (kindOf(joints, link)) {
    case JointKind::kRevolute:
      return body.setupRevolute(link, mass, inertia, parent, turn, axis, to_pivot, to_link, true);
    case JointKind::kPrismatic:
      return body.setupPrismatic(link, mass, inertia, parent, turn, axis, to_pivot, to_link, true);
    case JointKind::kSpherical:
      return body.setupSpherical(link, mass, inertia, parent, turn, to_pivot, to_link, true);
    case JointKind::kFixed:
      return body.setupFixed(link, mass, inertia, parent, turn, to_pivot, to_link);
    case JointKind::kPlanar:
      return body.setupPlanar(link, mass, inertia, parent, turn, axis, to_pivot, true);
  }
}

void startJoint(Arbitrary& arbitrary, btMultiBody& body, int link, double speed) {
  btScalar position[4] = {bt(arbitrary.between(-0.7, 0.7)), bt(arbitrary.between(-0.2, 0.2)),
                          bt(arbitrary.between(-0.2, 0.2)), 0};
  if (body.getLink(link).m_jointType == btMultibodyLink::eSpherical) {
    const btQuaternion turn = arbitraryTurn(arbitrary);
    for (int i = 0; i < 4; ++i) position[i] = turn[i];
  }
  if (body.getLink(link).m_posVarCount > 0) body.setJointPosMultiDof(link, position);
  btScalar rates[3];
  for (btScalar& rate : rates) rate = bt(2 * speed * arbitrary.between(-1, 1));
  body.setJointVelMultiDof(link, rates);
}

}  // namespace

RobotWorld::RobotWorld() {
  world.setGravity({0, 0, 0});
  btContactSolverInfo& info = world.getSolverInfo();
  info.m_erp = info.m_erp2 = info.m_linearSlop = 0;
  info.m_numIterations = 400;
  info.m_leastSquaresResidualThreshold = 0;
  info.m_restitutionVelocityThreshold = 0;
}

RobotWorld::~RobotWorld() {
  for (const auto& object : objects_) world.removeCollisionObject(object.get());
}

std::unique_ptr<btMultiBody> arbitraryRobot(Arbitrary& arbitrary, const RobotDef& def) {
  const btScalar mass = bt(arbitrary.between(0.7, 1.3));
  auto robot = std::make_unique<btMultiBody>(
      def.links, mass, btVector3(bt(0.02), bt(0.03), bt(0.025)), def.has_fixed_base, true);
  btMultiBody& body = *robot;
  body.setLinearDamping(0);
  body.setAngularDamping(0);
  body.setMaxCoordinateVelocity(bt(1e10));
  body.setHasSelfCollision(false);
  body.setCanSleep(false);
  body.setBasePos(toBullet(arbitrary.vector()));
  body.setWorldToBaseRot(arbitraryTurn(arbitrary));
  for (int i = 0; i < def.links; ++i) setupLink(arbitrary, body, i, def.joints);
  body.finalizeMultiDof();
  for (int i = 0; i < def.links; ++i) startJoint(arbitrary, body, i, def.speed);
  if (!def.has_fixed_base) {
    body.setBaseOmega(bt(2 * def.speed) * direction(arbitrary));
    body.setBaseVel(bt(def.speed) * direction(arbitrary));
  }
  return robot;
}

btMultiBody& RobotWorld::add(Arbitrary& arbitrary, const RobotDef& def) {
  return take(arbitraryRobot(arbitrary, def), def.collider_radius);
}

btMultiBody& RobotWorld::take(std::unique_ptr<btMultiBody> robot, double collider_radius) {
  btMultiBody& body = *robot;
  contents.take(std::move(robot));
  for (int i = -1; collider_radius > 0 && i < body.getNumLinks(); ++i) {
    shapes_.push_back(std::make_unique<btSphereShape>(bt(collider_radius)));
    btMultiBodyLinkCollider& collider =
        contents.addCollider(body, i, *shapes_.back(), btBroadphaseProxy::StaticFilter);
    collider.setFriction(0);
    collider.setRestitution(1);
  }
  moveColliders(body);
  return body;
}

void RobotWorld::take(std::unique_ptr<btMultiBodyConstraint> constraint) {
  contents.take(std::move(constraint)).finalizeMultiDof();
}

btCollisionObject& RobotWorld::addFixed(std::unique_ptr<btCollisionShape> shape,
                                        const btTransform& place) {
  shapes_.push_back(std::move(shape));
  objects_.push_back(std::make_unique<btCollisionObject>());
  btCollisionObject& object = *objects_.back();
  object.setCollisionShape(shapes_.back().get());
  object.setWorldTransform(place);
  object.setFriction(0);
  world.addCollisionObject(&object, btBroadphaseProxy::StaticFilter,
                           btBroadphaseProxy::DefaultFilter);
  return object;
}

void RobotWorld::moveColliders(btMultiBody& body) {
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  body.forwardKinematics(rotations, origins);
  body.updateCollisionObjectWorldTransforms(rotations, origins);
}

AttachDef coupledFluid(Arbitrary& arbitrary, const btMultiBody& body, int link, double ratio) {
  const double mass = static_cast<double>(link < 0 ? body.getBaseMass() : body.getLinkMass(link));
  Vector6 size;
  size << Vector3::Constant(link < 0 ? 0.2 : 0.15), Vector3::Ones();
  const Matrix6 added =
      ratio * mass / 3 * (size.asDiagonal() * arbitrary.positiveDefinite() * size.asDiagonal());
  AttachDef def{std::make_shared<FluidBody>(shapeWithoutFaces(added, 0)), idealFluid(1)};
  return def;
}

void putIntoFluid(Arbitrary& arbitrary, RobotWorld& world, btMultiBody& body, double ratio) {
  for (int i = body.hasFixedBase() ? 0 : -1; i < body.getNumLinks(); ++i)
    world.fluid.add(body, i, coupledFluid(arbitrary, body, i, ratio));
}

void holdTip(RobotWorld& world, btMultiBody& body) {
  const int tip = body.getNumLinks() - 1;
  const btVector3 point(bt(0.15), 0, 0);
  auto joint = std::make_unique<btMultiBodyPoint2Point>(
      &body, tip, static_cast<btRigidBody*>(nullptr), point,
      body.getLink(tip).m_cachedWorldTransform * point);
  joint->setMaxAppliedImpulse(bt(1e9));
  world.take(std::move(joint));
}

Eigen::VectorXd velocityOf(const btMultiBody& body) {
  Eigen::VectorXd u(6 + body.getNumDofs());
  readVelocity(body, u);
  return u;
}

double relativeError(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

}  // namespace ambient::test
