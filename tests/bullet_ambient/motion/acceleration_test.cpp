#include <gtest/gtest.h>

#include "bullet_ambient/motion/rows/row_velocity.h"
#include "tests/reference/full_inertia_accelerations.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/convergence.h"

namespace ambient {
namespace {

using reference::AccelerationCase;
using test::FreeBody;

FreeBody bodyOf(const AccelerationCase& c) {
  FreeBody body({test::shapeWithoutFaces(reference::fullInertia() - Matrix6::Identity(), 0)});
  body.state.orientation = Quaternion(c.orientation.normalized());
  const Quaternion to_body = body.state.orientation.conjugate();
  body.state.twist = {to_body * Vector3(c.angular_velocity), to_body * Vector3(c.linear_velocity)};
  body.surroundings.applied = {c.torque, c.force};
  return body;
}

Vector6 worldVelocity(const FreeBody& body) {
  return stack(body.state.orientation * body.state.twist.angular,
               body.state.orientation * body.state.twist.linear);
}

Vector6 expectedAcceleration(const AccelerationCase& c) {
  return stack(c.angular_acceleration, c.linear_acceleration);
}

TEST(RowVelocity, HasTheAccelerationsOfAnotherSimulator) {
  for (const AccelerationCase& c : reference::fullInertiaAccelerations()) {
    const FreeBody body = bodyOf(c);
    constexpr double kStep = 1.0 / 1024;
    const RowVelocity row =
        computeRowVelocity({body.model(), body.surroundings, body.settings, kStep}, body.state);
    // Rows use half of the turning part.
    const Vector6 whole = row.change_W.vector() + row.turning_W.vector();
    const Vector6 error = whole / kStep - expectedAcceleration(c);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-12);  // uncertainty of the reference
  }
}

TEST(Leapfrog, HasTheAccelerationsOfAnotherSimulator) {
  for (const AccelerationCase& c : reference::fullInertiaAccelerations()) {
    const auto central_difference = [&](double h) {
      FreeBody forwards = bodyOf(c);
      FreeBody backwards = bodyOf(c);  // time reversed
      backwards.state.twist = Twist::fromVector(-backwards.state.twist.vector());
      forwards.advance(h);
      backwards.advance(h);
      return Vector6((worldVelocity(forwards) + worldVelocity(backwards)) / (2 * h));
    };
    const Vector6 error =
        test::limitAtZero(central_difference, {0.1, 5, 2}) - expectedAcceleration(c);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace ambient
