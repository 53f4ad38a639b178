#include <gtest/gtest.h>

#include "tests/bullet_ambient/bullet/worlds/coupled_scene.h"

// User's forces and damping on a body of coupled K.
namespace ambient::test {
namespace {

TEST(ForceFeatures, AForceAtAPointIsFeltThroughTheFullInertia) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    CoupledScene scene(seed);
    scene.stop();
    scene.body().applyForce(toBt(scene.arbitrary.vector(1 / CoupledScene::kInstant)),
                            toBt(scene.arbitrary.vector(0.3)));
    const DenseVector6 expected = scene.coupled.dense(bt(CoupledScene::kInstant)).free_velocity;
    scene.scene.step(CoupledScene::kInstant);
    EXPECT_LT(scene.coupled.error(expected, expected), byPrecision(1e-12, 1e-4)) << seed;
  }
}

TEST(ForceFeatures, DampingScalesTheVelocityBeforeEachStep) {
  const double dt = 1.0 / 128;
  CoupledScene damped(4), scaled(4);
  damped.body().setDamping(bt(0.3), bt(0.5));
  for (int i = 0; i < 128; ++i) {
    btRigidBody& body = scaled.body();
    body.setLinearVelocity(body.getLinearVelocity() * btPow(bt(0.7), bt(dt)));
    body.setAngularVelocity(body.getAngularVelocity() * btPow(bt(0.5), bt(dt)));
    damped.scene.step(dt);
    scaled.scene.step(dt);
  }
  const DenseVector6 expected = scaled.coupled.velocity();
  EXPECT_LT(damped.coupled.error(expected, expected), byPrecision(1e-12, 1e-4));
  EXPECT_LT(expected.norm(), 0.8 * CoupledScene(4).coupled.velocity().norm());
}

}  // namespace
}  // namespace ambient::test
