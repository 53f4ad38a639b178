#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/motion/kernel_fixture.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;

class PoseKernels : public test::FlightKernelTest {
 protected:
  // Mean twist over a second from one orientation to another.
  Vector3 rotationVector(const Quaternion& from, const Quaternion& to) const {
    EndLanes lanes{};
    lanes.duration = 1;
    setLane(lanes.start_orientation, 3, from);
    setLane(lanes.orientation, 3, to);
    kernel_->findEnds(lanes);
    return vectorOf(lanes.mean_W, 3);
  }
};

TEST_P(PoseKernels, ReadEveryOrientationOfAMatrix) {
  Arbitrary arbitrary(1);
  for (int round = 0; round < 200; ++round) {
    StartLanes lanes{};
    Matrix3 rotations[kFlightLanes];
    Twist twists[kFlightLanes];
    for (int i = 0; i < kFlightLanes; ++i) {
      // Half turns and turns close to them; quarter turns, which have several equal entries.
      Vector3 axis = arbitrary.vector().normalized();
      if (round % 4 < 3) axis = Matrix3::Identity().col(round % 4);
      const double angle = i < 2 ? kPi : i < 4 ? kPi * (1 - 1e-9) : i * kPi / 6;
      rotations[i] =
          round % 2 == 0 ? Matrix3(rotationFromVector(angle * axis)) : arbitrary.rotation();
      twists[i] = arbitrary.twist(10, 10);
      for (int row = 0; row < 3; ++row)
        setLane(lanes.rotation + 3 * row, i, Vector3(rotations[i].row(row).transpose()));
      setLane(lanes.twist_W, i, twists[i]);
    }
    kernel_->readStarts(lanes);
    for (int i = 0; i < kFlightLanes; ++i) {
      const Quaternion q = orientationOf(lanes.orientation, i);
      EXPECT_NEAR(q.norm(), 1, 4e-16);
      EXPECT_LT((q.toRotationMatrix() - rotations[i]).cwiseAbs().maxCoeff(), 2e-15);
      const Twist back = twistOf(lanes.twist_B, i);
      EXPECT_LT((rotations[i] * back.angular - twists[i].angular).norm(), 1e-13);
      EXPECT_LT((rotations[i] * back.linear - twists[i].linear).norm(), 1e-13);
    }
  }
}

TEST_P(PoseKernels, FindTheRotationVectorOfEveryAngle) {
  Arbitrary arbitrary(2);
  for (const double angle : {0.0, 1e-300, 1e-20, 1e-8, 0.01, 0.1, 0.34, 0.35, 1.0, 3.1, kPi}) {
    const Vector3 r = angle * arbitrary.vector().normalized();
    const Vector3 back = rotationVector(Quaternion::Identity(), rotationFromVector(r));
    // At pi both signs of the axis give equal turns.
    const double error = std::min((back - r).norm(), angle > 3.14 ? (back + r).norm() : 1.0);
    EXPECT_LE(error, 6e-16 * angle) << angle;
    const Quaternion start(arbitrary.rotation());
    const Vector3 turned = rotationVector(start, rotationFromVector(r) * start);
    const double turned_error =
        std::min((turned - r).norm(), angle > 3.14 ? (turned + r).norm() : 1.0);
    EXPECT_LE(turned_error, 1e-15 * std::max(angle, 1.0)) << angle;
  }
}

TEST_P(PoseKernels, TakeTheShortWayForEitherSignOfTheQuaternion) {
  const Quaternion q(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()));
  const Quaternion same(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((rotationVector(Quaternion::Identity(), same) - Vector3(1, 0, 0)).norm(), 1e-15);
}

TEST_P(PoseKernels, GiveTheVelocitiesThatReachTheEnd) {
  Arbitrary arbitrary(3);
  EndLanes lanes{};
  lanes.duration = 0.02;
  const Quaternion start(arbitrary.rotation()), end(arbitrary.rotation());
  const Vector3 from = arbitrary.vector(), to = arbitrary.vector();
  const Twist twist = arbitrary.twist();
  setLane(lanes.start_orientation, 5, start);
  setLane(lanes.orientation, 5, end);
  setLane(lanes.start_position, 5, from);
  setLane(lanes.position, 5, to);
  setLane(lanes.twist_B, 5, twist);
  kernel_->findEnds(lanes);
  const Twist mean = twistOf(lanes.mean_W, 5), twist_W = twistOf(lanes.twist_W, 5);
  const Quaternion reached = rotationFromVector(0.02 * mean.angular) * start;
  EXPECT_LT(std::abs(std::abs(reached.dot(end)) - 1), 1e-15);
  EXPECT_LT((from + 0.02 * mean.linear - to).norm(), 1e-15);
  EXPECT_LT((twist_W.angular - end * twist.angular).norm(), 1e-14);
  EXPECT_LT((twist_W.linear - end * twist.linear).norm(), 1e-14);
}

TEST_P(PoseKernels, LeaveOutVelocitiesBelowTheLeast) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EndLanes lanes{};
  lanes.duration = 0.5;
  lanes.least = 1e-6;
  setLane(lanes.start_orientation, 2, Quaternion::Identity());
  setLane(lanes.orientation, 2, Quaternion::Identity());
  setLane(lanes.position, 2, Vector3(-0.49e-6, 0.51e-6, 0));
  const Twist twist{Vector3(-0.99e-6, -1.01e-6, kNaN), Vector3(1.01e-6, 0.99e-6, 1)};
  setLane(lanes.twist_B, 2, twist);
  kernel_->findEnds(lanes);
  const Twist mean = twistOf(lanes.mean_W, 2);
  EXPECT_EQ(mean.linear.x(), 0);
  EXPECT_EQ(mean.linear.y(), 0.51e-6 / lanes.duration);
  EXPECT_TRUE(std::isnan(lanes.twist_W[2][2]));
  lanes.twist_B[2][2] = 0;
  kernel_->findEnds(lanes);
  const Twist end = twistOf(lanes.twist_W, 2);
  EXPECT_EQ(end.angular, Vector3(0, -1.01e-6, 0));
  EXPECT_EQ(end.linear, Vector3(1.01e-6, 0, 1));
}

TEST_P(PoseKernels, HaveTheBitsOfTheBaseline) {
  Arbitrary arbitrary(4);
  for (int round = 0; round < 50; ++round) {
    StartLanes departure{};
    EndLanes arrival{};
    arrival.duration = arbitrary.between(1e-3, 1);
    for (int i = 0; i < kFlightLanes; ++i) {
      const Matrix3 rotation = arbitrary.rotation();
      for (int row = 0; row < 3; ++row)
        setLane(departure.rotation + 3 * row, i, Vector3(rotation.row(row).transpose()));
      setLane(departure.twist_W, i, arbitrary.twist());
      setLane(arrival.start_orientation, i, Quaternion(rotation));
      const Quaternion turn =
          rotationFromVector(arbitrary.vector(round % 2 == 0 ? 2 : 0.1)) * Quaternion(rotation);
      setLane(arrival.orientation, i, turn);
      setLane(arrival.start_position, i, arbitrary.vector());
      setLane(arrival.position, i, arbitrary.vector());
      setLane(arrival.twist_B, i, arbitrary.twist());
    }
    StartLanes other_departure = departure;
    EndLanes other_arrival = arrival;
    kernel_->readStarts(departure);
    kernel_->findEnds(arrival);
    kFlightKernelBaseline.readStarts(other_departure);
    kFlightKernelBaseline.findEnds(other_arrival);
    EXPECT_EQ(std::memcmp(departure.orientation, other_departure.orientation,
                          sizeof departure.orientation),
              0);
    EXPECT_EQ(std::memcmp(departure.twist_B, other_departure.twist_B, sizeof departure.twist_B), 0);
    EXPECT_EQ(std::memcmp(arrival.twist_W, other_arrival.twist_W, sizeof arrival.twist_W), 0);
    EXPECT_EQ(std::memcmp(arrival.mean_W, other_arrival.mean_W, sizeof arrival.mean_W), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PoseKernels, test::kAllInstructionSets);

}  // namespace
}  // namespace ambient
