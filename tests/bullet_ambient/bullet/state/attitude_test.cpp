#include "bullet_ambient/bullet/core/attitude.h"

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <LinearMath/btTransformUtil.h>
#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"

// Attitudes to which Bullet turns bodies, by our sine and cosine.
namespace ambient::test {
namespace {

TEST(Attitudes, AreThoseOfBulletsIntegration) {
  Arbitrary arbitrary(3);
  for (const double turn : {1e-9, 1e-4, 0.01, 0.3, 0.78, 0.8, 1.5, 6.0, 40.0}) {
    const Quaternion from =
        Quaternion(0.5, arbitrary.vector().x(), arbitrary.vector().y(), 0.3).normalized();
    const Vector3 spin = 60 * turn * arbitrary.vector().normalized();  // [rad/s]
    btTransform to;
    btTransformUtil::integrateTransform(btTransform(toBullet(from)), btVector3(0, 0, 0),
                                        toBullet(spin), bt(1.0 / 60), to);
    const Quaternion ours = turnedByBullet(from, spin / 60);
    EXPECT_LT(ours.angularDistance(toQuaternion(to.getRotation())), byPrecision(1e-7, 2e-3))
        << turn;
  }
}

TEST(Attitudes, AreSettledUnlessOthersHaveTurnedTheBody) {
  FluidWorld scene;
  btRigidBody& body = scene.add(BodyDef{});
  const Quaternion near(1, byPrecision(1e-12, 1e-6), 0, 0), far(1, 0.01, 0, 0);
  body.setLinearVelocity({1, 2, 3});
  settleAttitude(body, near.normalized());
  EXPECT_NE(body.getWorldTransform().getBasis()[2][1], bt(0));
  EXPECT_EQ(body.getInterpolationWorldTransform(), body.getWorldTransform());
  const btTransform before = body.getWorldTransform();
  settleAttitude(body, far.normalized());
  EXPECT_EQ(body.getWorldTransform(), before);
}

// Stops a body in the middle of its way, as continuous collision detection does.
struct HalfWay : btActionInterface {
  explicit HalfWay(btRigidBody& stopped) : body(stopped), start(stopped.getWorldTransform()) {}
  void updateAction(btCollisionWorld*, btScalar time_step) override {
    btTransform half;
    btTransformUtil::integrateTransform(start, body.getLinearVelocity(), body.getAngularVelocity(),
                                        time_step / 2, half);
    body.proceedToTransform(half);
  }
  void debugDraw(btIDebugDraw*) override {}

  btRigidBody& body;
  btTransform start;
};

TEST(Attitudes, OfABodyThatWasStoppedAreThoseOfItsWay) {
  FluidWorld scene;
  BodyDef def{1, ellipsoidMoments(Vector3::Constant(0.1), 1), {}, nullptr};
  def.start.twist = {Vector3(6, 0, 0), Vector3(60, 0, 0)};
  btRigidBody& body = scene.add(def, facelessEllipsoid(Vector3::Constant(0.1)), idealFluid(1));
  HalfWay stop(body);
  scene.removeAction();
  scene.world.addAction(&stop);
  scene.addAction();
  scene.step(kWorldStep);
  const btTransform& pose = body.getWorldTransform();
  EXPECT_NEAR(static_cast<double>(pose.getOrigin().x()), 30 * kWorldStep, byPrecision(1e-12, 1e-6));
  const double turned = 3 * kWorldStep;
  EXPECT_LT(toQuaternion(pose.getRotation())
                .angularDistance(Quaternion(Eigen::AngleAxisd(turned, Vector3(1, 0, 0)))),
            byPrecision(1e-7, 1e-3));
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().x()), 6, byPrecision(1e-12, 1e-5));
  scene.world.removeAction(&stop);
}

}  // namespace
}  // namespace ambient::test
