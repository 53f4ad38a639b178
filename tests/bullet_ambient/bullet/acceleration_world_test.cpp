#include <gtest/gtest.h>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/full_inertia_accelerations.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/extrapolation.h"

namespace ambient::test {
namespace {

TEST(FreeFlight, HasTheAccelerationsOfAnotherSimulator) {
  for (const reference::AccelerationCase& c : reference::fullInertiaAccelerations()) {
    // (u(h) - u(-h)) / 2h; a step back in time is a step forward with the velocity reversed.
    const auto difference = [&](double h) {
      Vector6 sum = Vector6::Zero();
      for (const double sign : {1.0, -1.0}) {
        FluidWorld world;
        BodyDef def;
        def.start.orientation = Quaternion(c.orientation.normalized());
        def.start.twist = {sign * c.angular_velocity, sign * c.linear_velocity};
        btRigidBody& body =
            world.add(def, shapeWithoutFaces(reference::fullInertia() - Matrix6::Identity(), 0),
                      {1, 0, Vector3::Zero(), Vector3::Zero()});
        body.applyCentralForce(toBullet(Vector3(c.force)));
        body.applyTorque(toBullet(Vector3(c.torque)));
        world.step(h);
        sum += stack(toVector3(body.getAngularVelocity()), toVector3(body.getLinearVelocity()));
      }
      return Vector6(sum / (2 * h));
    };
    const Vector6 acceleration = kDouble ? limitAtZero(difference, {1.0 / 16, 5, 2})
                                         : limitAtZero(difference, {1.0 / 8, 3, 2});
    const Vector6 expected = stack(c.angular_acceleration, c.linear_acceleration);
    // float64: uncertainty of the reference; float32: rounding of velocities over 1/32 s.
    EXPECT_LT((acceleration - expected).cwiseAbs().maxCoeff(), byPrecision(1e-12, 5e-5));
  }
}

}  // namespace
}  // namespace ambient::test
