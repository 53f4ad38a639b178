#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Motion of one body at one time. Axes are those of the body's shape; the position is that of its
/// centre of mass; the twist is in world axes, its linear part the velocity of the centre of mass.
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
