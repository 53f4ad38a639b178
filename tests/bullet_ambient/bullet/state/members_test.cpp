#include <LinearMath/btTransformUtil.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <iterator>
#include <list>
#include <map>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Addresses at the distance of Bullet's bodies, none of which is read.
const btCollisionObject* addressOf(int number) {
  return reinterpret_cast<const btCollisionObject*>(std::uintptr_t{704} * number + 4096);
}

TEST(BodyIndex, FindsWhatWasInsertedAndNotErased) {
  constexpr int kAddresses = 300;
  Arbitrary arbitrary(1);
  std::list<AmbientBody> bodies;
  std::map<int, BodyIndex::Place> known;
  BodyIndex index;
  EXPECT_FALSE(index.find(addressOf(0)));
  for (int i = 0; i < 5000; ++i) {
    const int number = static_cast<int>(arbitrary.between(0, kAddresses));
    const auto found = known.find(number);
    if (found == known.end()) {
      bodies.emplace_back();
      index.insert(addressOf(number), std::prev(bodies.end()));
      known[number] = std::prev(bodies.end());
    } else {
      index.erase(addressOf(number));
      bodies.erase(found->second);
      known.erase(found);
    }
    if (i % 50 != 0) continue;
    for (int other = 0; other < kAddresses; ++other) {
      const auto place = index.find(addressOf(other));
      const auto expected = known.find(other);
      ASSERT_EQ(place.has_value(), expected != known.end()) << i << ' ' << other;
      if (place) {
        ASSERT_EQ(*place, expected->second) << i << ' ' << other;
      }
    }
  }
  EXPECT_GT(known.size(), 100U);
  index.clear();
  EXPECT_FALSE(index.find(addressOf(1)));
}

TEST(StartStates, AreTheStatesOfSingleBodies) {
  Arbitrary arbitrary(1);
  btSphereShape sphere(1);
  std::deque<btRigidBody> rigid;
  std::deque<AmbientBody> ambient(kFlightsTogether);
  AmbientBody* bodies[kFlightsTogether];
  for (int i = 0; i < kFlightsTogether; ++i) {
    btRigidBody& body = rigid.emplace_back(1, nullptr, &sphere, btVector3(1, 1, 1));
    body.setWorldTransform(
        btTransform(toBullet(Quaternion(arbitrary.rotation())), toBullet(arbitrary.vector(3))));
    body.setAngularVelocity(toBullet(arbitrary.vector(5)));
    body.setLinearVelocity(toBullet(arbitrary.vector(5)));
    body.applyCentralForce(toBullet(arbitrary.vector()));
    bodies[i] = &ambient[static_cast<std::size_t>(i)];
    bodies[i]->body = &body;
  }
  const double rounding = byPrecision(1e-14, 1e-6);
  for (const int count : {1, 5, kFlightsTogether}) {
    StartStates departures;
    readStartStates(bodies, count, departures);
    for (int i = 0; i < count; ++i) {
      const RigidState &state = departures.states[i], expected = readState(*bodies[i]->body);
      EXPECT_LT((state.orientation.toRotationMatrix() - expected.orientation.toRotationMatrix())
                    .cwiseAbs()
                    .maxCoeff(),
                rounding);
      EXPECT_EQ(state.position, expected.position);
      EXPECT_LT((state.twist.vector() - expected.twist.vector()).norm(), 20 * rounding);
      EXPECT_EQ(departures.twists_W[i].vector(), ambient::velocityOf(*bodies[i]->body).vector());
      EXPECT_EQ(departures.surroundings[i].applied.force,
                toVector3(bodies[i]->body->getTotalForce()));
    }
  }
}

// Attitudes to which Bullet turns bodies, by our sine and cosine.

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

TEST(Attitudes, OfABodyThatWasStoppedAreThoseOfItsWay) {
  FluidWorld scene;
  BodyDef def{1, ellipsoidMoments(Vector3::Constant(0.1), 1), {}, nullptr};
  def.start.twist = {Vector3(6, 0, 0), Vector3(60, 0, 0)};
  btRigidBody& body = scene.add(def, facelessEllipsoid(Vector3::Constant(0.1)), idealFluid(1));
  // Stops the body in the middle of its way, as continuous collision detection does.
  const btTransform start = body.getWorldTransform();
  const OtherAction stop(scene, [&] {
    btTransform half;
    btTransformUtil::integrateTransform(start, body.getLinearVelocity(), body.getAngularVelocity(),
                                        bt(kWorldStep / 2), half);
    body.proceedToTransform(half);
  });
  scene.step(kWorldStep);
  const btTransform& pose = body.getWorldTransform();
  EXPECT_NEAR(static_cast<double>(pose.getOrigin().x()), 30 * kWorldStep, byPrecision(1e-12, 1e-6));
  const double turned = 3 * kWorldStep;
  EXPECT_LT(toQuaternion(pose.getRotation())
                .angularDistance(Quaternion(Eigen::AngleAxisd(turned, Vector3(1, 0, 0)))),
            byPrecision(1e-7, 1e-3));
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().x()), 6, byPrecision(1e-12, 1e-5));
}

}  // namespace
}  // namespace ambient::test
