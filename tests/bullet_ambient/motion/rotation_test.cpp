#include "bullet_ambient/motion/rotation.h"

#include <gtest/gtest.h>

#include "tests/support/random_bodies.h"

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

}  // namespace
}  // namespace ambient
