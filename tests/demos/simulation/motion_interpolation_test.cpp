#include <gtest/gtest.h>

#include <cmath>

#include "demos/simulation/output/motion_recorder.h"

namespace ambient {
namespace {

/// Sample of a body on a curved path that turns about a turning axis: q = Rz(a t) Rx(b
/// t).
MotionSample motionAt(double t) {
  const double a = 3, b = 20;
  MotionSample sample;
  sample.time = t;
  sample.position = Vector3(std::sin(2 * t), std::cos(3 * t), t * t * t);
  sample.twist.linear = Vector3(2 * std::cos(2 * t), -3 * std::sin(3 * t), 3 * t * t);
  const Eigen::Quaterniond about_z(Eigen::AngleAxisd(a * t, Eigen::Vector3d::UnitZ()));
  sample.orientation = about_z * Eigen::AngleAxisd(b * t, Eigen::Vector3d::UnitX());
  sample.twist.angular = a * Vector3::UnitZ() + b * (about_z * Eigen::Vector3d::UnitX());
  return sample;
}

struct PoseError {
  double position = 0;
  double angle = 0;
};

PoseError largestError(double step) {
  PoseError largest;
  for (const double share : {0.2, 0.5, 0.7}) {
    const double t = 0.4 + share * step;
    const MotionSample exact = motionAt(t);
    const MotionSample between = interpolateMotion(motionAt(0.4), motionAt(0.4 + step), t);
    largest.position = std::max(largest.position, (between.position - exact.position).norm());
    largest.angle = std::max(largest.angle, between.orientation.angularDistance(exact.orientation));
  }
  return largest;
}

TEST(MotionInterpolation, PosesAreOfFourthOrderAtLeast) {
  const PoseError coarse = largestError(0.04);
  const PoseError fine = largestError(0.02);
  EXPECT_GE(std::log2(coarse.position / fine.position), 3.8);
  EXPECT_GE(std::log2(coarse.angle / fine.angle), 3.8);
}

TEST(MotionInterpolation, EndsAreTheSamplesThemselves) {
  const MotionSample from = motionAt(1), to = motionAt(1.01);
  EXPECT_EQ(interpolateMotion(from, to, 1).position, from.position);
  EXPECT_EQ(interpolateMotion(from, to, 1.01).orientation.coeffs(), to.orientation.coeffs());
}

TEST(MotionInterpolation, AnEvenSpinOfMoreThanHalfATurnPerStepGoesAllTheWay) {
  const double spin = 264;  // golf ball [rad/s]
  for (const double step : {0.005, 0.015, 0.03}) {
    MotionSample from, to;
    from.twist.angular = to.twist.angular = Vector3(0, spin, 0);
    to.time = step;
    to.orientation = Eigen::AngleAxisd(spin * step, Eigen::Vector3d::UnitY());
    const MotionSample between = interpolateMotion(from, to, 0.3 * step);
    const Quaternion expected(Eigen::AngleAxisd(0.3 * spin * step, Eigen::Vector3d::UnitY()));
    EXPECT_NEAR(between.orientation.angularDistance(expected), 0, 1e-7) << step;
  }
}

}  // namespace
}  // namespace ambient
