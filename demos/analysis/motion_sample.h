#pragma once

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

}  // namespace ambient
