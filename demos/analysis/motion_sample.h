#pragma once

#include <vector>

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Motion of one body at one time. position: centre of mass in W [m]. orientation: axes of the
/// shape. twist: angular velocity, and velocity of the centre of mass, in world axes.
struct MotionSample {
  double time = 0;  ///< [s]
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();  ///< shape's axes to W
  Twist twist;

  bool isFinite() const {
    return position.allFinite() && orientation.coeffs().allFinite() && twist.angular.allFinite() &&
           twist.linear.allFinite();
  }
};

/// Appends a sample, with the sign of its quaternion that is nearer to the one before.
inline void appendSample(std::vector<MotionSample>& motion, MotionSample sample) {
  if (!motion.empty() && sample.orientation.dot(motion.back().orientation) < 0)
    sample.orientation.coeffs() *= -1;
  motion.push_back(sample);
}

}  // namespace ambient
