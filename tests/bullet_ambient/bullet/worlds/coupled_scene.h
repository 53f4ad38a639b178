#pragma once

#include <cmath>

#include "tests/bullet_ambient/bullet/contact/coupled_body.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/free_body.h"
#include "tests/support/random_bodies.h"

namespace ambient::test {

/// One body with a coupled K in an ideal fluid, its collision shape a sphere about the centre of
/// mass, in a world without gravity and without Bullet's corrections of position.
class CoupledScene {
 public:
  static constexpr double kRadius = 0.25;

  explicit CoupledScene(unsigned seed, double fluid_ratio = 3)
      : arbitrary(seed), coupled(CoupledBody::random(arbitrary, fluid_ratio)) {
    body().setCollisionShape(&ball_);
    body().setActivationState(DISABLE_DEACTIVATION);
    body().setFriction(0);
    btContactSolverInfo& info = fluid.world.getSolverInfo();
    info.m_splitImpulse = 0;
    info.m_erp = info.m_erp2 = 0;
    info.m_restitutionVelocityThreshold = 0;
    info.m_numIterations = 500;
    fluid.world.addRigidBody(&body());
    coupled.attachTo(fluid.registry);
  }
  ~CoupledScene() { fluid.world.removeRigidBody(&body()); }

  btRigidBody& body() { return coupled.body(); }
  void stop() {
    body().setLinearVelocity({0, 0, 0});
    body().setAngularVelocity({0, 0, 0});
  }
  /// A step without the action: velocities stay those that the rows were solved for.
  void solve(double duration) {
    fluid.world.removeAction(&fluid.action);
    fluid.step(duration);
    fluid.world.addAction(&fluid.action);
  }
  /// In which forces and gyroscopic terms change the velocities by nothing; Bullet does not step
  /// over less than its epsilon.
  static constexpr double kInstant = byPrecision(1e-14, 1e-6);

  Arbitrary arbitrary;
  CoupledBody coupled;
  FluidWorld fluid;

 private:
  btSphereShape ball_{static_cast<btScalar>(kRadius)};
};

/// A fixed wall with the outward normal `normal` in the path of the scene's body, overlapping it by
/// a millimetre.
class Wall {
 public:
  Wall(CoupledScene& scene, const btVector3& normal)
      : scene_(scene),
        plane_(normal, normal.dot(scene.body().getWorldTransform().getOrigin()) -
                           static_cast<btScalar>(CoupledScene::kRadius - 1e-3)) {
    body_.setFriction(0);
    scene_.fluid.world.addRigidBody(&body_);
  }
  ~Wall() { scene_.fluid.world.removeRigidBody(&body_); }

 private:
  CoupledScene& scene_;
  btStaticPlaneShape plane_;
  btRigidBody body_{0, nullptr, &plane_};
};

}  // namespace ambient::test
