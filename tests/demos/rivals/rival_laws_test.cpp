// Load laws of the models compared in the demos, on a sphere.

#include "demos/rivals/rival_laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient {
namespace {

constexpr double kBallRadius = 0.11;
constexpr double kDensity = 1.204;

Wrench loadOnBall(const LoadLaw& law, const Twist& twist) {
  LoadSettings settings;
  settings.density = kDensity;
  const auto ball = std::make_shared<const FluidBody>(test::gaussSphere(kBallRadius));
  return law(ball, settings)->load(twist);
}

TEST(LinearDrag, OfASphereIsForceByVelocityAndTorqueBySpin) {
  const double drag_speed = 0.7;
  const Twist twist{{5, -3, 60}, {30, 4, -2}};
  const Wrench load = loadOnBall(linearDrag(drag_speed), twist);
  const double area = 4 * kPi * kBallRadius * kBallRadius;
  const Vector3 force = -kDensity * drag_speed * area * twist.linear;
  const Vector3 torque =
      -2.0 / 3 * kDensity * drag_speed * area * kBallRadius * kBallRadius * twist.angular;
  EXPECT_LE((load.force - force).norm(), 1e-12 * force.norm());
  EXPECT_LE((load.torque - torque).norm(), 1e-12 * torque.norm());
}

TEST(LinearDrag, RefusesASpeedThatIsNotPositive) {
  for (const double speed : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(linearDrag(speed), std::invalid_argument);
}

TEST(WindwardFlux, OfASphereHasDragOneAndASideForceAgainstMagnus) {
  // With v along z the faces' rule integrates the windward half exactly.
  const double speed = 30, spin = 60;
  const Twist twist{{spin, 0, 0}, {0, 0, speed}};
  const Wrench load = loadOnBall(windwardFlux(), twist);
  const double drag = 0.5 * kDensity * speed * speed * kPi * kBallRadius * kBallRadius;
  const double side = kPi / 3 * kDensity * std::pow(kBallRadius, 3) * speed * spin;
  // Magnus' force is along w x v = -y.
  EXPECT_LE((load.force - Vector3(0, side, -drag)).norm(), 1e-12 * drag);
  const double torque = -3.0 / 8 * kPi * kDensity * speed * std::pow(kBallRadius, 4) * spin;
  EXPECT_LE((load.torque - Vector3(torque, 0, 0)).norm(), 1e-12 * std::abs(torque));
}

TEST(WindwardFlux, TakesPowerFromEveryMotion) {
  for (const Twist& twist : {Twist{{1, 2, 3}, {0, 0, 0}}, Twist{{-40, 5, 90}, {3, -7, 1}},
                             Twist{{0, 0, 0}, {0.1, 0.2, 0.3}}})
    EXPECT_LE(power(loadOnBall(windwardFlux(), twist), twist), 0);
}

}  // namespace
}  // namespace ambient
