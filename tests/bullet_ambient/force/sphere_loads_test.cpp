#include "bullet_ambient/force/loads/sphere_loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "tests/reference/loads/sphere_loads.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::sphere_loads {
namespace {

constexpr double kDensity = 1.7, kViscosity = 2e-5, kSpeed = 3.5, kRadius = 0.6;
const double kLength = std::sqrt(4 * kPi) * kRadius;
const double kPressureUnit = 0.5 * kDensity * kSpeed * kSpeed * kPi * kRadius * kRadius;
const double kFrictionUnit =
    kPressureUnit * 0.0576 * std::pow(kDensity * kSpeed * kLength / kViscosity, -0.2);
constexpr double kAngles[] = {1, 1.01, 1.1, 1.2, 1.5, 1.8, 2};  // over pi/2

class Sphere {
 public:
  explicit Sphere(double right_angles, bool friction = true)
      : settings_{kDensity, kViscosity, separationCosine(right_angles * kPi / 2), friction} {
    if (!needsSphereTable(settings_)) return;
    static std::map<double, std::shared_ptr<const SphereTable>> tables;  // each takes a while
    table_ = tables[settings_.separation_cosine];
    if (!table_) {
      table_ = sharedSphereTable(settings_.separation_cosine);
      tables[settings_.separation_cosine] = table_;
    }
  }
  FaceLoads loads(const Twist& twist) const {
    return computeSphereLoads(table_.get(), kRadius, kLength, twist, settings_);
  }
  FaceLoads loadsOf(const FaceTable& faces, const Twist& twist) const {
    return computeFaceLoads(faces, kLength, twist, settings_);
  }

 private:
  LoadSettings settings_;
  std::shared_ptr<const SphereTable> table_;
};

// A smooth sphere as points of equal area along a spiral.
FaceTable spiralOfPoints(int points) {
  FaceTable faces;
  const double golden = kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < points; ++i) {
    const double z = 1 - (2 * i + 1.0) / points, r = std::sqrt(1 - z * z);
    const Vector3 n(r * std::cos(golden * i), r * std::sin(golden * i), z);
    faces.add(n, kRadius * n, 4 * kPi * kRadius * kRadius / points);
  }
  return faces;
}

// Random twist: the speeds of centre and equator add up to kSpeed.
Twist arbitraryTwist(test::Arbitrary& arbitrary) {
  const double share = arbitrary.between(0, 1);
  const Vector3 spin = arbitrary.vector().normalized() * (share * kSpeed / kRadius);
  return {spin, arbitrary.vector().normalized() * ((1 - share) * kSpeed)};
}

double distance(const Wrench& a, const Wrench& b) {
  return std::hypot((a.force - b.force).norm(), (a.torque - b.torque).norm() / kRadius);
}

TEST(SphereLoads, AreThoseOfManyFacesForAnySpinAndAngle) {
  const FaceTable points = spiralOfPoints(50000);
  for (const double angle : kAngles) {
    test::Arbitrary arbitrary(7);
    const Sphere sphere(angle);
    double pressure_sq = 0, friction_sq = 0;
    constexpr int kMotions = 20;
    for (int i = 0; i < kMotions; ++i) {
      const Twist twist = arbitraryTwist(arbitrary);
      const FaceLoads found = sphere.loads(twist), expected = sphere.loadsOf(points, twist);
      const double pressure = distance(found.pressure, expected.pressure) / kPressureUnit;
      const double friction = distance(found.friction, expected.friction) / kFrictionUnit;
      // Discretisation by points: 1e-3 at pi/2, where the pressure has no jump.
      EXPECT_LT(std::max(pressure, friction), 8e-3) << angle;
      pressure_sq += pressure * pressure / kMotions;
      friction_sq += friction * friction / kMotions;
    }
    EXPECT_LT(std::sqrt(std::max(pressure_sq, friction_sq)), 1e-3) << angle;
  }
}

TEST(SphereLoads, HaveTheCoefficientsOfTheSmoothSphere) {
  for (const reference::SpinningSphere& p : reference::spinningSpheres()) {
    SCOPED_TRACE(std::to_string(p.angle) + ", " + std::to_string(p.S));
    const Sphere sphere(p.angle, false);
    const Vector3 velocity(kSpeed, 0, 0), spin(0, 0, p.S * kSpeed / kRadius);
    for (const double sense : {1, -1}) {
      const Wrench load = sphere.loads({sense * spin, velocity}).pressure;
      const double tolerance = (p.angle == 1 ? 1e-14 : 1.5e-4) * (1 + p.S) * (1 + p.S);
      EXPECT_NEAR(-load.force.x() / kPressureUnit, p.drag, tolerance);
      EXPECT_NEAR(sense * load.force.y() / kPressureUnit, p.lift, tolerance);
      EXPECT_NEAR(load.force.z() / kPressureUnit, 0, tolerance);
      EXPECT_EQ(load.torque.norm(), 0);
    }
  }
}

TEST(SphereLoads, FrictionIsThatOfTheClosedForms) {
  const reference::SphereInFluid fluid{kRadius, kDensity, kViscosity};
  for (const double angle : kAngles) {
    const Sphere sphere(angle);
    const double drag = reference::sphereFrictionDrag(fluid, kSpeed, angle * kPi / 2);
    const Wrench moving = sphere.loads({Vector3::Zero(), Vector3(0, -kSpeed, 0)}).friction;
    EXPECT_NEAR(moving.force.y(), drag, 1e-5 * drag) << angle;
    EXPECT_LT(moving.torque.norm(), 1e-12 * kRadius * drag);
    if (angle == 1) continue;
    const double torque = reference::sphereFrictionTorque(fluid, 9);
    const Wrench spinning = sphere.loads({Vector3(0, 0, 9), Vector3::Zero()}).friction;
    EXPECT_NEAR(spinning.torque.z(), -torque, 1e-4 * torque) << angle;
    EXPECT_LT(spinning.force.norm(), 1e-12 * torque / kRadius);
  }
}

TEST(SphereLoads, NeverFeedEnergyToTheBody) {
  for (const double angle : kAngles) {
    const Sphere sphere(angle);
    test::Arbitrary arbitrary(8);
    for (int i = 0; i < 5000; ++i) {
      const Twist twist = arbitraryTwist(arbitrary);
      const FaceLoads loads = sphere.loads(twist);
      EXPECT_LE(power(loads.pressure, twist), 1e-14 * kPressureUnit * kSpeed) << angle;
      EXPECT_LT(power(loads.friction, twist), 0) << angle;
    }
  }
}

TEST(SphereLoads, TurnWithTheMotionAndGrowWithItsPowers) {
  test::Arbitrary arbitrary(9);
  const Sphere sphere(1.5);
  for (int i = 0; i < 50; ++i) {
    const Twist twist = arbitraryTwist(arbitrary);
    const Matrix3 turn = arbitrary.rotation();
    const FaceLoads loads = sphere.loads(twist);
    const FaceLoads turned = sphere.loads({3 * (turn * twist.angular), 3 * (turn * twist.linear)});
    const double friction = std::pow(3, 1.8);
    const auto expected = [&](const Wrench& load, double factor) {
      return Wrench{factor * (turn * load.torque), factor * (turn * load.force)};
    };
    EXPECT_LT(distance(turned.pressure, expected(loads.pressure, 9)), 1e-11 * kPressureUnit);
    EXPECT_LT(distance(turned.friction, expected(loads.friction, friction)), 1e-11 * kFrictionUnit);
  }
}

TEST(SphereLoads, AreNoneAtRestAndNeverNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double angle : {1.0, 1.5}) {
    const Sphere sphere(angle);
    const Vector3 zero = Vector3::Zero();
    EXPECT_EQ(sphere.loads({zero, zero}).total().vector().norm(), 0);
    if (angle == 1) {
      EXPECT_EQ(sphere.loads({Vector3(0, 9, 0), zero}).total().vector().norm(), 0);
    }
    for (const double size : {1e-300, 1e-150, 1e150, 1e300, nan}) {
      for (const Twist& twist : {Twist{Vector3(size, 0, 0), zero}, Twist{zero, Vector3(0, size, 0)},
                                 Twist{Vector3(0, 1, 0), Vector3(size, size, 0)}})
        EXPECT_TRUE(sphere.loads(twist).total().vector().allFinite()) << size;
    }
  }
}

}  // namespace
}  // namespace ambient::sphere_loads
