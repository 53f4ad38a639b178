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

CostWorld::CostWorld() { world_.setGravity(btVector3(0, 0, btScalar(-9.81))); }

CostWorld::~CostWorld() {
  fluid_.reset();
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
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
  world_.addRigidBody(&body);
  return body;
}

void CostWorld::addJoint(std::unique_ptr<btTypedConstraint> joint) {
  world_.addConstraint(joint.get(), true);
  joints_.push_back(std::move(joint));
}

void CostWorld::immerse() {
  fluid_ = std::make_unique<Fluid>(world_);
  if (has_surface) fluid_->addRegion(waterBelow(0));
  if (attach) return attach(*fluid_, bodies_);
  if (!fluid_->addAll(shapes_, water()).refused.empty()) std::exit(EXIT_FAILURE);
}

void CostWorld::step() {
  const auto dt = static_cast<btScalar>(duration);
  world_.stepSimulation(dt, 0, dt);
}

}  // namespace ambient::test
