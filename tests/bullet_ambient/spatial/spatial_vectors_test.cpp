#include "bullet_ambient/spatial/spatial_vectors.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

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

// Rounding of a few dozen operations on numbers of order 1 to 10.
constexpr double kShiftRounding = 1e-13;

class FrameOffsetTest : public testing::Test {
 protected:
  test::Arbitrary arbitrary_{7};
  FrameOffset offset_{arbitrary_.rotation(), arbitrary_.vector()};
};

TEST_F(FrameOffsetTest, MovesTheSameBodyPointInBothFrames) {
  const Twist x_B = arbitrary_.twist();
  const Vector3 p_F = arbitrary_.vector();
  const Vector3 p_B = offset_.rotation * p_F + offset_.translation;
  const Vector3 velocity_F = offset_.toF(x_B).at(p_F);
  EXPECT_LT((offset_.rotation * velocity_F - x_B.at(p_B)).norm(), kShiftRounding);
}

TEST_F(FrameOffsetTest, TakesAForceAtAPointToThatForceAtThatPoint) {
  const Vector3 force_F = arbitrary_.vector();
  const Vector3 p_F = arbitrary_.vector();
  const Vector3 p_B = offset_.rotation * p_F + offset_.translation;
  const Wrench expected = Wrench::ofForceAt(offset_.rotation * force_F, p_B);
  const Wrench f_B = offset_.toB(Wrench::ofForceAt(force_F, p_F));
  EXPECT_LT((f_B.vector() - expected.vector()).norm(), kShiftRounding);
}

TEST_F(FrameOffsetTest, KeepsThePower) {
  for (int i = 0; i < 100; ++i) {
    const Twist x_B = arbitrary_.twist();
    const Wrench f_F{arbitrary_.vector(), arbitrary_.vector()};
    EXPECT_NEAR(power(offset_.toB(f_F), x_B), power(f_F, offset_.toF(x_B)),
                kShiftRounding * x_B.vector().norm() * f_F.vector().norm());
  }
}

TEST_F(FrameOffsetTest, KeepsTheKineticEnergy) {
  const Matrix6 K_F = arbitrary_.positiveDefinite();
  const Twist x_B = arbitrary_.twist();
  const Vector6 x_F = offset_.toF(x_B).vector();
  const double energy = x_F.dot(K_F * x_F) / 2;
  EXPECT_NEAR(x_B.vector().dot(offset_.inertiaToB(K_F) * x_B.vector()) / 2, energy,
              kShiftRounding * energy);
}

TEST_F(FrameOffsetTest, OfNothingChangesNothing) {
  const Twist x = arbitrary_.twist();
  const Wrench f{arbitrary_.vector(), arbitrary_.vector()};
  const Matrix6 K = arbitrary_.positiveDefinite();
  EXPECT_EQ(FrameOffset{}.toF(x).vector(), x.vector());
  EXPECT_EQ(FrameOffset{}.toB(f).vector(), f.vector());
  EXPECT_EQ(FrameOffset{}.inertiaToB(K), K);
}

TEST(RotationFromVector, TurnsAboutTheVectorByItsLength) {
  test::Arbitrary arbitrary(2);
  for (const double angle : {1e-5, 0.3, 2.0, 6.0, 100.0}) {
    const Vector3 axis = arbitrary.vector().normalized();
    const Matrix3 expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Matrix3 R = rotationFromVector(angle * axis).toRotationMatrix();
    EXPECT_LT((R - expected).cwiseAbs().maxCoeff(), 1e-14) << angle;
  }
}

TEST(RotationVector, IsThatOfTheQuaternionOrItsNegative) {
  test::Arbitrary arbitrary(3);
  for (const double angle : {0.0, 1e-200, 1e-20, 1e-5, 0.3, 2.0, 3.1}) {
    const Vector3 expected = angle * arbitrary.vector().normalized();
    const Quaternion q = rotationFromVector(expected);
    EXPECT_LE((rotationVector(q) - expected).norm(), 4e-16 * angle) << angle;
    EXPECT_EQ(rotationVector(Quaternion(-q.coeffs())), rotationVector(q)) << angle;
  }
}

TEST(RotationBetween, TakesOneDirectionToTheOther) {
  test::Arbitrary arbitrary(4);
  for (int i = 0; i < 100; ++i) {
    const Vector3 from = 1e-3 * arbitrary.vector(), to = 1e5 * arbitrary.vector();
    const Vector3 turned = rotationBetween(from, to) * from.normalized();
    EXPECT_LT((turned - to.normalized()).norm(), 3e-15);
  }
  for (const Vector3& axis : {Vector3(Vector3::UnitX()), Vector3(1, -2, 3)}) {
    const Vector3 turned = rotationBetween(axis, -axis) * axis;
    EXPECT_LT((turned + axis).norm(), 1e-15 * axis.norm());
    EXPECT_LT(rotationVector(rotationBetween(axis, axis)).norm(), 1e-15);
  }
}

TEST(AngleBetween, IsThatOfTheRotation) {
  const Quaternion a = rotationFromVector({0.1, 0.2, -0.3}), turn = rotationFromVector({0, 0.7, 0});
  EXPECT_NEAR(angleBetween(a, a * turn), 0.7, 1e-15);
  EXPECT_NEAR(angleBetween(a, Quaternion(-(a * turn).coeffs())), 0.7, 1e-15);
}

TEST(IsTurnedFurther, ComparesTheAngleWithTheLimit) {
  test::Arbitrary arbitrary(4);
  const Quaternion a(arbitrary.rotation());
  for (const double angle : {0.0, 1e-9, 0.3, 1.5, 3.0, 3.14}) {
    const Quaternion b = a * rotationFromVector(angle * arbitrary.vector().normalized());
    const Quaternion opposite(-b.coeffs());
    for (const Quaternion& end : {b, opposite}) {
      EXPECT_FALSE(isTurnedFurther(a, end, angle + 1e-14)) << angle;
      EXPECT_TRUE(isTurnedFurther(a, end, angle - 1e-14)) << angle;
      EXPECT_EQ(isTurnedFurther(a, end, angle / 2), angle > 0) << angle;
      EXPECT_FALSE(isTurnedFurther(a, end, 4));
    }
  }
}

TEST(PrincipalFrame, GivesTheInertiaBack) {
  Matrix3 inertia;
  inertia << 2, 0.3, -0.2, 0.3, 3, 0.1, -0.2, 0.1, 4;
  const PrincipalFrame frame = findPrincipalFrame(inertia);
  const Matrix3 moments = frame.moments.asDiagonal();
  const Matrix3 back = frame.rotation * moments * frame.rotation.transpose();
  EXPECT_LE((back - inertia).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(frame.rotation.determinant(), 1, 1e-14);
}

TEST(PrincipalFrame, KeepsTheAxesOfADiagonalInertia) {
  Matrix3 inertia = Vector3(5, 1, 3).asDiagonal();
  inertia(0, 1) = inertia(1, 0) = 1e-16;
  const PrincipalFrame frame = findPrincipalFrame(inertia);
  EXPECT_EQ(frame.rotation, Matrix3::Identity());
  EXPECT_EQ(frame.moments, Vector3(5, 1, 3));
}

}  // namespace
}  // namespace ambient
