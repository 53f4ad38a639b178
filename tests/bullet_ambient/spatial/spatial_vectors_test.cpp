#include "bullet_ambient/spatial/spatial_vectors.h"

#include <gtest/gtest.h>

namespace ambient {
namespace {

TEST(Twist, PutsRotationFirst) {
  const Twist x{{1, 2, 3}, {4, 5, 6}};
  Vector6 expected;
  expected << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(x.vector(), expected);
  EXPECT_EQ(Twist::fromVector(expected).angular, x.angular);
  EXPECT_EQ(Twist::fromVector(expected).linear, x.linear);
}

TEST(Twist, MovesAPointByItsLeverArm) {
  const Twist spin_about_z{{0, 0, 2}, {0, 0, 7}};
  EXPECT_EQ(spin_about_z.at(Vector3(3, 0, 0)), Vector3(0, 6, 7));
}

TEST(Wrench, OfAForceHasTheTorqueOfItsLeverArm) {
  const Wrench f = Wrench::ofForceAt(Vector3(0, 5, 0), Vector3(2, 0, 0));
  EXPECT_EQ(f.torque, Vector3(0, 0, 10));
  EXPECT_EQ(f.force, Vector3(0, 5, 0));
}

TEST(Wrench, OfAForceDoesThePowerOfThatForceOnItsPoint) {
  const Vector3 force(1.5, -2, 0.25);
  const Vector3 position(0.5, 3, -1);
  const Twist x{{0.5, -1.5, 2}, {4, 0.25, -3}};
  // Numbers short in binary: no rounding.
  EXPECT_EQ(power(Wrench::ofForceAt(force, position), x), force.dot(x.at(position)));
}

TEST(Wrench, AddsAndScalesByComponent) {
  const Wrench a{{1, 2, 3}, {4, 5, 6}};
  const Wrench b{{10, 20, 30}, {40, 50, 60}};
  EXPECT_EQ((a + 2 * b).vector(), a.vector() + 2 * b.vector());
}

TEST(Momentum, PutsRotationFirst) {
  const Momentum m{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(m.vector().head<3>(), m.angular);
  EXPECT_EQ(Momentum::fromVector(m.vector()).linear, m.linear);
}

}  // namespace
}  // namespace ambient
