#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/motion/links/link_tree.h"
#include "tests/support/bodies/random_trees.h"

namespace ambient {
namespace {

constexpr JointKind kKinds[] = {JointKind::kFixed, JointKind::kRevolute, JointKind::kPrismatic,
                                JointKind::kSpherical, JointKind::kPlanar};

using Rotation = Eigen::AngleAxisd;
using Spin = Eigen::Quaterniond;

Eigen::Vector3d axis(const Joint& joint, int i) {
  const Vector6& S = joint.axes[i];
  return i == 0 && joint.kind != JointKind::kPrismatic ? S.head<3>() : S.tail<3>();
}

// Copy of Bullet 3.24's btMultiBody::stepPositionsMultiDof, for turns of less than pi/4.
JointPosition movedByBullet(const Joint& joint, JointPosition p, const double* u, double h) {
  switch (joint.kind) {
    case JointKind::kFixed:
      break;
    case JointKind::kRevolute:
    case JointKind::kPrismatic:
      p[0] += h * u[0];
      break;
    case JointKind::kSpherical: {
      const Spin q(p[3], p[0], p[1], p[2]);
      const Eigen::Vector3d w = q * Eigen::Vector3d(u[0], u[1], u[2]);
      const Spin turned = Spin(Rotation(h * w.norm(), w.normalized())) * q;
      p = {turned.x(), turned.y(), turned.z(), turned.w()};
      break;
    }
    case JointKind::kPlanar: {
      p[0] += h * u[0];
      const Eigen::Vector3d v =
          Rotation(p[0], axis(joint, 0)) * (u[1] * axis(joint, 1) + u[2] * axis(joint, 2));
      p[1] += h * axis(joint, 1).dot(v);
      p[2] += h * axis(joint, 2).dot(v);
    }
  }
  return p;
}

double distance(const JointPosition& a, const JointPosition& b) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

TEST(Joint, MovesAsInBulletButForPlanarOnes) {
  test::Arbitrary arbitrary(1);
  for (const JointKind kind : kKinds) {
    if (kind == JointKind::kPlanar) continue;
    for (const double speed : {1e-7, 1e-3, 1.0, 20.0}) {
      const Joint joint = test::randomJoint(arbitrary, kind);
      const JointPosition start = test::randomPosition(arbitrary, kind);
      const Vector3 u = arbitrary.vector(speed);
      const JointPosition expected = movedByBullet(joint, start, u.data(), 0.01);
      JointPosition end = moved(joint, start, u.data(), 0.01);
      for (int i = axisCount(kind); i < 4; ++i)
        if (axisCount(kind) < 3) end[i] = expected[i];  // unused
      EXPECT_LT(distance(end, expected), 1e-14) << speed;
    }
  }
}

TEST(Joint, BulletComesToTheEndByTheVelocityBetween) {
  test::Arbitrary arbitrary(2);
  for (const JointKind kind : kKinds) {
    for (const double speed : {1e-7, 1e-3, 1.0, 20.0}) {
      const Joint joint = test::randomJoint(arbitrary, kind);
      const JointPosition start = test::randomPosition(arbitrary, kind);
      const Vector3 u = arbitrary.vector(speed);
      const JointPosition end = moved(joint, start, u.data(), 0.01);
      Vector3 mean = Vector3::Zero();
      velocityBetween(joint, start, end, 0.01, mean.data());
      JointPosition reached = movedByBullet(joint, start, mean.data(), 0.01);
      for (int i = axisCount(kind); i < 4; ++i)
        if (axisCount(kind) < 3) reached[i] = end[i];
      EXPECT_LT(distance(reached, end), 1e-14) << speed;
    }
  }
}

// Rate of the pose must equal the axes S times the joint rates: V = E^T-rotated change of offset.
TEST(Joint, AxesAreTheRatesOfTheOffset) {
  test::Arbitrary arbitrary(3);
  for (const JointKind kind : kKinds) {
    const Joint joint = test::randomJoint(arbitrary, kind);
    const JointPosition start = test::randomPosition(arbitrary, kind);
    const Vector3 u = arbitrary.vector();
    Vector6 rate = Vector6::Zero();
    for (int i = 0; i < axisCount(kind); ++i) rate += u[i] * joint.axes[i];
    constexpr double kTime = 1e-5;
    const FrameOffset before = linkOffset(joint, moved(joint, start, u.data(), -kTime));
    const FrameOffset after = linkOffset(joint, moved(joint, start, u.data(), kTime));
    const Matrix3 R = linkOffset(joint, start).rotation;
    const Matrix3 turn = R.transpose() * (after.rotation - before.rotation) / (2 * kTime);
    const Vector3 way = R.transpose() * (after.translation - before.translation) / (2 * kTime);
    const Vector3 spin(turn(2, 1), turn(0, 2), turn(1, 0));
    EXPECT_LT((stack(spin, way) - rate).norm(), 1e-8);  // order 2 in kTime
  }
}

TEST(Joint, HalfAWayTwiceIsTheWay) {
  test::Arbitrary arbitrary(4);
  for (const JointKind kind : kKinds) {
    const Joint joint = test::randomJoint(arbitrary, kind);
    const JointPosition start = test::randomPosition(arbitrary, kind);
    const Vector3 u = arbitrary.vector(10);
    const JointPosition middle = moved(joint, start, u.data(), 0.05);
    const JointPosition end = moved(joint, start, u.data(), 0.1);
    EXPECT_LT(distance(moved(joint, middle, u.data(), 0.05), end), 1e-14);
    EXPECT_LT(distance(moved(joint, end, u.data(), -0.05), middle), 1e-14);
  }
}

}  // namespace
}  // namespace ambient
