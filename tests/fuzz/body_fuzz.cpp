#include <cmath>
#include <stdexcept>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/impulse.h"
#include "tests/fuzz/fuzz_scene.h"

namespace ambient::test {

Medium FuzzScene::anyMedium() {
  Medium medium;
  if (chance(0.2)) return medium;
  medium.density = std::pow(10, arbitrary_.between(-2, 3.3));
  if (chance(0.8)) medium.viscosity = std::pow(10, arbitrary_.between(-6, 0));
  if (chance(0.5)) medium.velocity = arbitrary_.vector(2);
  if (chance(0.2)) medium.acceleration = arbitrary_.vector();
  return medium;
}

// Default integrator only: Runge-Kutta steps are unstable at some speeds and densities.
AttachDef FuzzScene::anyDef() {
  AttachDef def;
  def.fluid_body =
      fluid_bodies_[static_cast<std::size_t>(below(static_cast<int>(fluid_bodies_.size())))];
  def.medium = anyMedium();
  if (chance(0.3)) {
    def.flow.law = PressureLaw::kPublished;
    def.flow.separation_angle = arbitrary_.between(1.5708, 2.5);
  } else if (chance(0.5)) {
    def.flow.roughness = std::pow(10, arbitrary_.between(-6, -1));
  }
  def.flow.skin_friction = chance(0.7);
  if (chance(0.5)) {
    def.fluid_frame.rotation = arbitrary_.rotation();
    def.fluid_frame.translation = arbitrary_.vector(0.1);
  }
  return def;
}

void FuzzScene::addBody() {
  if (bodies_.size() >= 24) return;
  btCollisionShape* const shapes[] = {&box_, &ball_, &capsule_, &pair_of_balls_};
  btCollisionShape* shape = shapes[below(is_repeatable_ ? 3 : 4)];
  FuzzBody fuzz;
  fuzz.mass = static_cast<btScalar>(std::pow(10, arbitrary_.between(-1, 2.5)));
  btVector3 inertia;
  shape->calculateLocalInertia(fuzz.mass, inertia);
  fuzz.body = std::make_unique<btRigidBody>(fuzz.mass, nullptr, shape, inertia);
  btTransform pose(toBullet(Quaternion(arbitrary_.rotation())), vector(2));
  pose.getOrigin().setZ(1 + std::abs(pose.getOrigin().z()));
  fuzz.body->setCenterOfMassTransform(pose);
  fuzz.body->setLinearVelocity(vector(2));
  fuzz.body->setAngularVelocity(vector(5));
  fuzz.body->setRestitution(static_cast<btScalar>(arbitrary_.between(0, 0.8)));
  if (is_repeatable_) fuzz.body->setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(fuzz.body.get());
  bodies_.push_back(std::move(fuzz));
  if (chance(0.7)) {
    fluid_.add(*bodies_.back().body, anyDef());
    bodies_.back().is_attached = true;
  }
}

// Half of the attached ones without a word to the fluid.
void FuzzScene::destroyBody() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz) return;
  removeJointsOf(*fuzz->body);
  if (chance(0.5) && fuzz->is_attached) fluid_.find(*fuzz->body)->remove();
  if (fuzz->is_in_world) world_.removeRigidBody(fuzz->body.get());
  std::swap(*fuzz, bodies_.back());
  bodies_.pop_back();
}

void FuzzScene::moveBetweenWorldAndShelf() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz) return;
  if (fuzz->is_in_world) {
    removeJointsOf(*fuzz->body);
    world_.removeRigidBody(fuzz->body.get());
  } else {
    world_.addRigidBody(fuzz->body.get());
  }
  fuzz->is_in_world = !fuzz->is_in_world;
}

void FuzzScene::attach() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz || fuzz->is_attached || fuzz->body->isStaticOrKinematicObject()) return;
  fluid_.add(*fuzz->body, anyDef());
  fuzz->is_attached = true;
}

void FuzzScene::attachWrongly() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz || fuzz->is_attached) return;
  AttachDef def = anyDef();
  switch (below(4)) {
    case 0:
      def.medium.density = -1;
      break;
    case 1:
      def.fluid_body = nullptr;
      break;
    case 2:
      def.flow.separation_angle = 4;
      break;
    default:
      def.medium.velocity.x() = std::nan("");
  }
  try {
    fluid_.add(*fuzz->body, def);
  } catch (const std::invalid_argument&) {
    return;
  }
  throw std::logic_error("an attachment that is wrong was taken");
}

void FuzzScene::detach() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz || !fuzz->is_attached) return;
  if (!fluid_.find(*fuzz->body)->remove()) {
    throw std::logic_error("an attached body could not be detached");
  }
  fuzz->is_attached = false;
}

void FuzzScene::changeMedium() {
  FuzzBody* fuzz = anyBody();
  if (fuzz && fuzz->is_attached) fluid_.find(*fuzz->body)->setMedium(anyMedium());
}

void FuzzScene::changeShape() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz || !fuzz->is_attached) return;
  auto shape = anyDef().fluid_body;
  if (chance(0.5)) {
    const double factor = arbitrary_.between(0.5, 2);
    auto larger = std::make_shared<FluidBody>(scaled(*shape, factor));
    larger->name += " scaled " + std::to_string(++scaled_count_);
    shape = larger;
    if (fluid_bodies_.size() < 12) fluid_bodies_.push_back(larger);
  }
  fluid_.find(*fuzz->body)->setFluidBody(shape);
}

// Sets a random mass, including 0. Bullet requires a change from or to 0 outside of the world.
void FuzzScene::changeMass() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz) return;
  btRigidBody& body = *fuzz->body;
  if (fuzz->is_in_world) world_.removeRigidBody(&body);
  btScalar mass = 0;
  btVector3 inertia(0, 0, 0);
  if (body.getInvMass() == 0 || chance(0.7)) {
    mass = static_cast<btScalar>(std::pow(10, arbitrary_.between(-1, 2.5)));
    body.getCollisionShape()->calculateLocalInertia(mass, inertia);
  }
  body.setMassProps(mass, inertia);
  body.updateInertiaTensor();
  if (mass == 0) {
    body.setLinearVelocity(btVector3(0, 0, 0));
    body.setAngularVelocity(btVector3(0, 0, 0));
  }
  if (fuzz->is_in_world) world_.addRigidBody(&body);
}

void FuzzScene::push() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz) return;
  btRigidBody& body = *fuzz->body;
  const btScalar strength = body.getMass() * static_cast<btScalar>(arbitrary_.between(0, 10));
  const btVector3 impulse = strength * vector(1), place = vector(0.2);
  switch (below(5)) {
    case 0:
      if (const auto in = fluid_.find(body))
        return in->applyImpulse(Wrench::ofForceAt(toVector3(impulse), toVector3(place)));
      return body.applyImpulse(impulse, place);
    case 1:
      if (const auto in = fluid_.find(body))
        return in->applyImpulse({0.1 * toVector3(impulse), Vector3::Zero()});
      return body.applyTorqueImpulse(btScalar(0.1) * impulse);
    case 2:
      return body.applyForce(10 * impulse, place);
    case 3:
      return body.applyImpulse(impulse, place);
    default:
      break;
  }
  const btVector3 n = impulse.normalized();
  // Bullet's own answer of a body with locked axes is not symmetric, and may be negative.
  const bool is_in_fluid = fuzz->is_attached && fluid_.find(body)->medium().density > 0;
  if (is_in_fluid && strength > 0 &&
      !(n.dot(inverseEffectiveMass(fluid_, body, place) * n) > btScalar(-1e-3))) {
    throw std::logic_error("an effective mass is negative");
  }
}

// All axes free or no rotation. Fast spin (much of a radian per step) with some axes locked gains
// energy. A linear axis locked while moving would leave a contact to stop this motion by rotation
// alone.
void FuzzScene::changeFactors() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz) return;
  btRigidBody& body = *fuzz->body;
  const btVector3 factor = chance(0.5) ? btVector3(1, 1, 1) : btVector3(0, 0, 0);
  body.setAngularFactor(factor);
  body.setAngularVelocity(body.getAngularVelocity() * factor);
}

void FuzzScene::changeFlags() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz) return;
  btRigidBody& body = *fuzz->body;
  if (chance(0.3)) body.setDamping(btScalar(0.1), btScalar(0.2));
  if (chance(0.3)) body.setFriction(static_cast<btScalar>(arbitrary_.between(0, 1)));
  if (chance(0.3)) body.setRollingFriction(btScalar(0.05));
  if (chance(0.2)) {
    body.setCcdMotionThreshold(btScalar(0.1));
    body.setCcdSweptSphereRadius(btScalar(0.1));
  }
}

void FuzzScene::changeSleep() {
  FuzzBody* fuzz = anyBody();
  if (!fuzz || is_repeatable_) return;
  fuzz->body->forceActivationState(chance(0.5) ? ACTIVE_TAG : ISLAND_SLEEPING);
}

}  // namespace ambient::test
