#include "bullet_ambient/bullet/core/attitude.h"

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

// Continuous collision detection stops a ball on its way; it has turned for that part of the step.
TEST(Attitudes, AreThoseWhereABodyWasStopped) {
  for (const bool spins : {false, true}) {
    FluidWorld scene;
    btSphereShape ball(bt(0.1));
    btBoxShape wall(btVector3(bt(0.01), 9, 9));
    BodyDef floor{0, Vector3::Zero(), {}, &wall};
    floor.start.position = {3, 0, 0};
    scene.add(floor);
    BodyDef def{1, ellipsoidMoments(Vector3::Constant(0.1), 1), {}, &ball};
    def.start.twist = {spins ? Vector3(6, 0, 0) : Vector3(0, 0, 0), Vector3(60, 0, 0)};
    btRigidBody& body = scene.add(def, facelessEllipsoid(Vector3::Constant(0.1)), idealFluid(1));
    body.setCcdMotionThreshold(bt(0.05));
    body.setCcdSweptSphereRadius(bt(0.05));
    double turned = 0;
    for (int i = 0; i < 12; ++i) {
      const btTransform before = body.getWorldTransform();
      scene.step(kWorldStep);
      const double way =
          static_cast<double>((body.getWorldTransform().getOrigin() - before.getOrigin()).length());
      turned = toQuaternion(before.getRotation())
                   .angularDistance(toQuaternion(body.getWorldTransform().getRotation()));
      if (way < 0.4) break;  // of half a metre
    }
    EXPECT_LT(body.getWorldTransform().getOrigin().x(), 3);
    EXPECT_LT(turned, spins ? 6 * kWorldStep : 1e-9);
  }
}

}  // namespace
}  // namespace ambient::test
