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
  if (shape.getShapeType() == CYLINDER_SHAPE_PROXYTYPE) {
    const btVector3 half = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
    return 2 * SIMD_PI * static_cast<double>(half.x() * half.x() * half.y());
  }
  if (shape.getShapeType() == CONE_SHAPE_PROXYTYPE) {
    const auto& cone = static_cast<const btConeShape&>(shape);
    const auto r = static_cast<double>(cone.getRadius());
    return SIMD_PI * r * r * static_cast<double>(cone.getHeight()) / 3;
  }
  const auto r = static_cast<double>(static_cast<const btSphereShape&>(shape).getRadius());
  return 4 * SIMD_PI * r * r * r / 3;
}

}  // namespace

CostWorld::CostWorld(bool has_robots) {
  if (has_robots) {
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher, &broadphase, &robot_solver_,
                                                        &configuration);
  } else {
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, &solver_,
                                                       &configuration);
  }
  world_->setGravity(btVector3(0, 0, btScalar(-9.81)));
  contents_.emplace(*world_);
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
  btRigidBody& body = contents_->add(mass, moments, *shape, start);
  collision_shapes_.push_back(std::move(shape));
  body.setActivationState(DISABLE_DEACTIVATION);
  return body;
}

void CostWorld::addRobot(const std::shared_ptr<btCollisionShape>& shape, double density, int links,
                         const btTransform& start) {
  constexpr double kPitch = 1.2, kSpin = 0.3;  // from link to link [m]; of joints [rad/s]
  const auto mass = static_cast<btScalar>(density * volumeOf(*shape));
  btVector3 moments;
  shape->calculateLocalInertia(mass, moments);
  auto owned = std::make_unique<btMultiBody>(links, mass, moments, false, false);
  btMultiBody& robot = *owned;
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
  contents_->take(std::move(owned));
  for (int link = -1; link < links; ++link)
    contents_->addCollider(robot, link, *shape).setActivationState(DISABLE_DEACTIVATION);
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  robot.forwardKinematics(rotations, origins);
  robot.updateCollisionObjectWorldTransforms(rotations, origins);
  collision_shapes_.push_back(shape);
}

void CostWorld::immerse() {
  fluid_.emplace(*world_);
  if (has_surface) fluid_->addRegion(waterBelow(0));
  if (attach) return attach(*fluid_, contents_->bodies());
  AttachSettings settings;
  if (!has_loads) settings.flow.own_law = [](const auto&, const auto&) { return nullptr; };
  if (!fluid_->addAll(shapes_, water(), settings).refused.empty()) std::exit(EXIT_FAILURE);
}

}  // namespace ambient::test
