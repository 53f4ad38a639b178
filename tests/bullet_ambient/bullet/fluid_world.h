#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/ambient_solver.h"
#include "tests/support/ellipsoid_body.h"

namespace ambient::test {

constexpr bool kDouble = sizeof(btScalar) == sizeof(double);

/// The tolerance of the precision that the test is compiled for.
constexpr double byPrecision(double in_double, double in_float) {
  return kDouble ? in_double : in_float;
}

inline btScalar bt(double value) { return static_cast<btScalar>(value); }

constexpr double kWorldStep = 1.0 / 120;  // [s]

inline const Vector3 kUnequalAxes(0.3, 0.25,
                                  0.1);  // of an ellipsoid without symmetry of revolution

inline Medium idealFluid(double density) { return {density, 0, Vector3::Zero(), Vector3::Zero()}; }

/// A dynamic body for the tests: mass properties and where it starts. Body axes are principal.
struct BodyDef {
  double mass = 1;
  Vector3 moments = Vector3::Ones();
  RigidState start{};  // twist in world axes here
  btCollisionShape* shape = nullptr;
};

/// A stock world with an ambient solver and its action, gravity 0.
class FluidWorld {
 public:
  FluidWorld() { world.setGravity({0, 0, 0}); }
  ~FluidWorld() {
    for (const auto& body : bodies_) world.removeRigidBody(body.get());
  }

  btRigidBody& add(const BodyDef& def) {
    btCollisionShape* shape = def.shape ? def.shape : &no_shape_;
    bodies_.push_back(std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
        static_cast<btScalar>(def.mass), nullptr, shape, toBullet(def.moments))));
    btRigidBody& body = *bodies_.back();
    body.setWorldTransform(
        btTransform(toBullet(def.start.orientation), toBullet(def.start.position)));
    body.setAngularVelocity(toBullet(def.start.twist.angular));
    body.setLinearVelocity(toBullet(def.start.twist.linear));
    body.setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(&body);
    return body;
  }
  btRigidBody& add(const BodyDef& def, const FluidBody& fluid_body, const Medium& medium) {
    btRigidBody& body = add(def);
    AttachDef attach;
    attach.fluid_body = std::make_shared<FluidBody>(fluid_body);
    attach.medium = medium;
    registry.attach(body, attach);
    return body;
  }
  void step(double duration, int count = 1) {
    const auto dt = static_cast<btScalar>(duration);
    for (int i = 0; i < count; ++i) world.stepSimulation(dt, 0, dt);
  }

  AmbientRegistry registry;
  AmbientSolver<> solver{registry};
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  AmbientAction action{registry};

 private:
  struct AddAction {
    AddAction(btDiscreteDynamicsWorld& w, AmbientAction& a) { w.addAction(&a); }
  } add_action_{world, action};
  btEmptyShape no_shape_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace ambient::test
