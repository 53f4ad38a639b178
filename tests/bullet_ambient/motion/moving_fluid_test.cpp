#include <gtest/gtest.h>

#include "bullet_ambient/motion/rows/row_velocity.h"
#include "demos/integrators/integrators.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::FreeBody;

constexpr double kWaterDensity = 1000;  // [kg/m^3]

// A faceted ellipsoid with its mass off centre: no term of the equations vanishes.
FreeBody loadedBody(OwnFlight integrator) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  const FluidBody shape = test::meshedEllipsoid(semi_axes, 1);
  const double mass = 1.2 * kWaterDensity * shape.volume;
  FrameOffset frame;
  frame.translation = {0.02, -0.01, 0.015};
  FreeBody body({shape,
                 {mass, test::ellipsoidMoments(semi_axes, mass).asDiagonal()},
                 {kWaterDensity, 1e-3, Vector3::Zero(), Vector3::Zero()},
                 {1.2 * 1.5707963267948966, true},
                 frame});
  body.settings.own_flight = integrator;
  body.setGravity({0, 0, -9.81});
  body.state.orientation = Quaternion(Arbitrary(7).rotation());
  body.state.twist = {{1, -2, 3}, {0.5, 1, -0.3}};
  return body;
}

constexpr OwnFlight kIntegrators[] = {nullptr, flyRungeKutta};
constexpr double kStep = 1.0 / 60;
constexpr int kDriftSteps = 60;

TEST(MovingFluid, ASteadyCurrentIsStillWaterSeenFromAMovingFrame) {
  const Vector3 current(0.7, -0.4, 0.2);
  for (const OwnFlight integrator : kIntegrators) {
    FreeBody still = loadedBody(integrator);
    FreeBody carried = loadedBody(integrator);
    carried.surroundings.ambient_velocity = current;
    carried.state.twist.linear += carried.state.orientation.conjugate() * current;
    still.advance(kStep, kDriftSteps);
    carried.advance(kStep, kDriftSteps);
    const Vector3 way = kDriftSteps * kStep * current;
    // Rounding of current added and subtracted, amplified by switching faces.
    EXPECT_LT((carried.state.position - still.state.position - way).norm(), 1e-12);
    EXPECT_LT(angleBetween(carried.state.orientation, still.state.orientation), 1e-11);
    const Vector3 relative =
        carried.state.twist.linear - carried.state.orientation.conjugate() * current;
    EXPECT_LT((relative - still.state.twist.linear).norm(), 1e-11);
    EXPECT_EQ(carried.count.load_evaluations, still.count.load_evaluations);
  }
}

TEST(MovingFluid, ItsAccelerationActsLikeGravityOnBodyAndDisplacedFluid) {
  const Vector3 acceleration(1, -2, 0.5), gravity(0, 0, -9.81);
  for (const OwnFlight integrator : kIntegrators) {
    FreeBody still = loadedBody(integrator);
    still.setGravity(gravity - acceleration);
    FreeBody carried = loadedBody(integrator);
    carried.setGravity(gravity);
    for (int i = 0; i < kDriftSteps; ++i) {
      carried.surroundings.ambient_velocity = i * kStep * acceleration;
      carried.surroundings.ambient_acceleration = acceleration;
      carried.advance(kStep);
      still.advance(kStep);
    }
    const double t = kDriftSteps * kStep;
    const Vector3 way = t * t / 2 * acceleration;
    EXPECT_LT((carried.state.position - still.state.position - way).norm(), 1e-11);
    EXPECT_LT(angleBetween(carried.state.orientation, still.state.orientation), 1e-10);
  }
}

TEST(MovingFluid, ChangesTheRowVelocityLikeFreeFlight) {
  // Over a short step both equal acceleration times step, except half of the turning part.
  FreeBody body = loadedBody(flyRungeKutta);
  body.surroundings.ambient_velocity = {0.7, -0.4, 0.2};
  body.surroundings.ambient_acceleration = {1, -2, 0.5};
  constexpr double kShort = 1e-6;
  const Vector3 before = body.state.orientation * body.state.twist.linear;
  const RowVelocity row =
      computeRowVelocity({body.model(), body.surroundings, body.settings, kShort}, body.state);
  body.advance(kShort);
  const Vector3 change = body.state.orientation * body.state.twist.linear - before;
  EXPECT_LT((row.change_W.linear + row.turning_W.linear - change).norm(), 1e-4 * change.norm());
}

}  // namespace
}  // namespace ambient
