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
  Arbitrary arbitrary;
  CoupledBody coupled;
  FluidWorld scene;

 private:
  btSphereShape ball_{static_cast<btScalar>(kRadius)};
};

}  // namespace ambient::test
