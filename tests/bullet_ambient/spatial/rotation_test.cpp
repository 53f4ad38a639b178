#include "bullet_ambient/spatial/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "bullet_ambient/spatial/principal_frame.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

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
