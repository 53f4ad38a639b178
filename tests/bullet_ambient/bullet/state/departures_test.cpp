#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <deque>

#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

TEST(Departures, AreTheStatesOfSingleBodies) {
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
    Departures departures;
    readDepartures(bodies, count, departures);
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

}  // namespace
}  // namespace ambient::test
