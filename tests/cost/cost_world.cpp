#include "tests/cost/cost_world.h"

#include <cstdlib>
#include <utility>

namespace ambient::test {
namespace {

// Volume of a simple shape [m^3].
double volumeOf(const btCollisionShape& shape) {
  if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
    const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
    return 8 * static_cast<double>(half.x() * half.y() * half.z());
  }
  if (shape.getShapeType() == CAPSULE_SHAPE_PROXYTYPE) {
    const auto& capsule = static_cast<const btCapsuleShape&>(shape);
    const auto r = static_cast<double>(capsule.getRadius());
    return SIMD_PI * r * r * (2 * static_cast<double>(capsule.getHalfHeight()) + 4 * r / 3);
  }
  const auto r = static_cast<double>(static_cast<const btSphereShape&>(shape).getRadius());
  return 4 * SIMD_PI * r * r * r / 3;
}

}  // namespace

CostWorld::CostWorld(bool has_robots) {
  if (has_robots) {
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_, &robot_solver_,
                                                        &configuration_);
  } else {
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, &solver_,
                                                       &configuration_);
  }
  world_->setGravity(btVector3(0, 0, btScalar(-9.81)));
}

CostWorld::~CostWorld() {
  fluid_.reset();
  for (const auto& joint : joints_) world_->removeConstraint(joint.get());
  for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  for (const auto& collider : colliders_) world_->removeCollisionObject(collider.get());
  auto* robots = dynamic_cast<btMultiBodyDynamicsWorld*>(world_.get());
  for (const auto& robot : robots_) robots->removeMultiBody(robot.get());
}

btRigidBody& CostWorld::add(std::shared_ptr<btCollisionShape> shape, double density,
                            const btTransform& start) {
  double mass = 0;
  if (density > 0) mass = density * volumeOf(*shape);
  btVector3 moments(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(static_cast<btScalar>(mass), moments);
  return addBody(std::move(shape), mass, moments, start);
}

btRigidBody& CostWorld::addBody(std::shared_ptr<btCollisionShape> shape, double mass,
                                const btVector3& moments, const btTransform& start) {
  bodies_.push_back(
      std::make_unique<btRigidBody>(static_cast<btScalar>(mass), nullptr, shape.get(), moments));
  collision_shapes_.push_back(std::move(shape));
  btRigidBody& body = *bodies_.back();
  body.setWorldTransform(start);
  body.setActivationState(DISABLE_DEACTIVATION);
  world_->addRigidBody(&body);
  return body;
}

void CostWorld::addJoint(std::unique_ptr<btTypedConstraint> joint) {
  world_->addConstraint(joint.get(), true);
  joints_.push_back(std::move(joint));
}

void CostWorld::addRobot(const std::shared_ptr<btCollisionShape>& shape, double density, int links,
                         const btTransform& start) {
  constexpr double kPitch = 1.2, kSpin = 0.3;  // from link to link [m]; of joints [rad/s]
  const auto mass = static_cast<btScalar>(density * volumeOf(*shape));
  btVector3 moments;
  shape->calculateLocalInertia(mass, moments);
  robots_.push_back(std::make_unique<btMultiBody>(links, mass, moments, false, false));
  btMultiBody& robot = *robots_.back();
  robot.setHasSelfCollision(false);
  const btVector3 half(0, static_cast<btScalar>(kPitch / 2), 0);
  for (int i = 0; i < links; ++i)
    robot.setupRevolute(i, mass, moments, i - 1, btQuaternion::getIdentity(),
                        i % 2 == 0 ? btVector3(1, 0, 0) : btVector3(0, 0, 1), half, half, true);
  robot.finalizeMultiDof();
  robot.setBasePos(start.getOrigin());
  robot.setWorldToBaseRot(start.getRotation().inverse());
  for (int i = 0; i < links; ++i)
    robot.setJointVel(i, static_cast<btScalar>(i % 3 == 0 ? kSpin : -kSpin));
  static_cast<btMultiBodyDynamicsWorld&>(*world_).addMultiBody(&robot);
  for (int link = -1; link < links; ++link) addCollider(robot, link, *shape);
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  robot.forwardKinematics(rotations, origins);
  robot.updateCollisionObjectWorldTransforms(rotations, origins);
  collision_shapes_.push_back(shape);
}

void CostWorld::addCollider(btMultiBody& robot, int link, btCollisionShape& shape) {
  colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(&robot, link));
  btMultiBodyLinkCollider& collider = *colliders_.back();
  collider.setCollisionShape(&shape);
  collider.setActivationState(DISABLE_DEACTIVATION);
  if (link < 0) {
    robot.setBaseCollider(&collider);
  } else {
    robot.getLink(link).m_collider = &collider;
  }
  world_->addCollisionObject(&collider);
}

void CostWorld::immerse() {
  fluid_ = std::make_unique<Fluid>(*world_);
  if (has_surface) fluid_->addRegion(waterBelow(0));
  if (attach) return attach(*fluid_, bodies_);
  AttachSettings settings;
  if (!has_loads) settings.flow.own_law = [](const auto&, const auto&) { return nullptr; };
  if (!fluid_->addAll(shapes_, water(), settings).refused.empty()) std::exit(EXIT_FAILURE);
}

void CostWorld::step() {
  const auto dt = static_cast<btScalar>(duration);
  world_->stepSimulation(dt, 0, dt);
}

}  // namespace ambient::test
