#include "bullet_ambient/motion/rotation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_bodies.h"

namespace ambient {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(RotationVector, IsTheInverseOfItsQuaternion) {
  test::Arbitrary arbitrary(1);
  for (const double angle : {0.0, 1e-300, 1e-20, 1e-8, 0.9999e-4, 1.0001e-4, 0.1, 1.0, 3.1, kPi}) {
    const Vector3 r = angle * arbitrary.vector().normalized();
    const Vector3 back = rotationVector(rotationFromVector(r));
    // At pi both signs of the axis are the same turn.
    const double error = std::min((back - r).norm(), angle > 3.14 ? (back + r).norm() : 1.0);
    EXPECT_LE(error, 4e-16 * angle) << angle;
  }
}

TEST(RotationVector, TakesTheShortWayForEitherSignOfTheQuaternion) {
  const Quaternion q(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()));
  const Quaternion same(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((rotationVector(same) - Vector3(1, 0, 0)).norm(), 1e-15);
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

}  // namespace
}  // namespace ambient
