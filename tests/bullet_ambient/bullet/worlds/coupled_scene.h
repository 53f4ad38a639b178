#pragma once

#include <cmath>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

/// One body with a coupled K in an ideal fluid, colliding as a sphere about the centre of mass.
/// World without gravity and without position correction.
class CoupledScene {
 public:
  static constexpr double kRadius = 0.25;

  explicit CoupledScene(unsigned seed, double fluid_ratio = 3)
      : arbitrary(seed), coupled(CoupledBody::random(arbitrary, fluid_ratio)) {
    body().setCollisionShape(&ball_);
    body().setActivationState(DISABLE_DEACTIVATION);
    body().setFriction(0);
    btContactSolverInfo& info = scene.world.getSolverInfo();
    info.m_splitImpulse = 0;
    info.m_erp = info.m_erp2 = 0;
    info.m_restitutionVelocityThreshold = 0;
    info.m_numIterations = 500;
    scene.world.addRigidBody(&body());
    coupled.attachTo(membersOf(scene.fluid));
  }
  ~CoupledScene() { scene.world.removeRigidBody(&body()); }

  btRigidBody& body() { return coupled.body(); }
  void stop() {
    body().setLinearVelocity({0, 0, 0});
    body().setAngularVelocity({0, 0, 0});
  }
  /// Steps without the action: velocities stay equal to the rows' solution.
  void solve(double duration) {
    scene.removeAction();
    scene.step(duration);
    scene.addAction();
  }
  /// Step [s] so short that forces and gyroscopic terms vanish; Bullet skips steps below its
  /// epsilon.
  static constexpr double kInstant = byPrecision(1e-14, 1e-6);

  Arbitrary arbitrary;
  CoupledBody coupled;
  FluidWorld scene;

 private:
  btSphereShape ball_{static_cast<btScalar>(kRadius)};
};

/// A fixed wall with the outward normal `normal` in the path of the body, overlapping by a
/// millimetre.
class Wall {
 public:
  Wall(CoupledScene& scene, const btVector3& normal)
      : scene_(scene),
        plane_(normal, normal.dot(scene.body().getWorldTransform().getOrigin()) -
                           static_cast<btScalar>(CoupledScene::kRadius - 1e-3)) {
    body_.setFriction(0);
    scene_.scene.world.addRigidBody(&body_);
  }
  ~Wall() { scene_.scene.world.removeRigidBody(&body_); }

 private:
  CoupledScene& scene_;
  btStaticPlaneShape plane_;
  btRigidBody body_{0, nullptr, &plane_};
};

}  // namespace ambient::test
