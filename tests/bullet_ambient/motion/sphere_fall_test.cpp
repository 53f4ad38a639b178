#include "tests/reference/sphere_fall.h"

#include <gtest/gtest.h>

#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"

namespace ambient {
namespace {

using reference::SphereFall;
using test::FreeBody;

constexpr double kGravity = 9.81;

FreeBody sphereOf(const SphereFall& fall) {
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;  // convergence down to 1e-9
  FreeBody sphere(
      {test::gaussSphere(fall.radius),
       {fall.mass, test::ellipsoidMoments(Vector3::Constant(fall.radius), fall.mass).asDiagonal()},
       {fall.density, 0, Vector3::Zero(), Vector3::Zero()},
       flow});
  sphere.setGravity({0, 0, -kGravity});
  return sphere;
}

constexpr SphereFall kBasketball{0.62, 0.12, 1.204, kGravity};  // in air
constexpr SphereFall kCork{0.05, 0.05, 998, kGravity};          // in water

TEST(SphereFall, HasTheReferenceNumbers) {
  // Reference numbers "sphere vertical fall closed form", uncertainty 1e-9.
  EXPECT_NEAR(kBasketball.terminalSpeed(), 20.985388032787, 1e-9);
  EXPECT_NEAR(kBasketball.settlingTime(), 2.184929401933346, 1e-9);
  EXPECT_NEAR(kBasketball.distance(7.540285264082085), 126.5, 1e-8);
}

// Largest velocity error over the terminal speed, within the settling time.
double largestError(const SphereFall& fall, const FlightSettings& settings, int steps) {
  FreeBody sphere = sphereOf(fall);
  sphere.settings = settings;
  const double step = fall.settlingTime() / steps;
  double largest = 0;
  for (int i = 1; i <= steps; ++i) {
    sphere.advance(step);
    const double error = -sphere.state.twist.linear.z() - fall.velocity(i * step);
    largest = std::max(largest, std::abs(error) / fall.terminalSpeed());
  }
  return largest;
}

TEST(Leapfrog, FallsAndRisesLikeTheClosedFormToSecondOrder) {
  const FlightSettings one_substep{1e-3, 1};
  for (const SphereFall& fall : {kBasketball, kCork}) {
    const double coarse = largestError(fall, one_substep, 25);
    const double fine = largestError(fall, one_substep, 100);
    EXPECT_LT(coarse, 2e-4);
    EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.1);
  }
}

TEST(Leapfrog, StartsWithTheAccelerationOfBodyAndAddedMass) {
  for (const SphereFall& fall : {kBasketball, kCork}) {
    FreeBody sphere = sphereOf(fall);
    constexpr double kStep = 1e-6;
    sphere.advance(kStep);
    EXPECT_NEAR(-sphere.state.twist.linear.z() / kStep, fall.firstAcceleration(),
                1e-9 * std::abs(fall.firstAcceleration()));
  }
}

TEST(Leapfrog, HasATerminalSpeedWithStepsOfAnyLength) {
  // Decay 1/v_2 - 1/v_1 = h / (V_t tau) between two halves of gravity's kick. Fixed point: v^2 =
  // V_t^2 + (g_eff h / 2)^2.
  for (const double ratio : {0.01, 0.1, 1.0, 5.0}) {
    FreeBody ball = sphereOf(kBasketball);
    ball.settings.max_substeps = 1;
    ball.advance(ratio * kBasketball.settlingTime(), 60);
    const double expected = kBasketball.terminalSpeed() * std::hypot(1, ratio / 2);
    const double reached = ratio * 60 > 20 ? 1 : std::tanh(ratio * 60);
    EXPECT_NEAR(-ball.state.twist.linear.z() / expected, reached, 1e-4) << ratio;
  }
}

}  // namespace
}  // namespace ambient
