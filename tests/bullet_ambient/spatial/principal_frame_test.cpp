#include "bullet_ambient/spatial/principal_frame.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace ambient {
namespace {

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
