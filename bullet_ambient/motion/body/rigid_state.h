#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Pose and velocity of a rigid body. Body frame B: origin at the centre of mass, axes fixed to the
/// body.
struct RigidState {
  Quaternion orientation = Quaternion::Identity();  ///< B to W, unit
  Vector3 position = Vector3::Zero();               ///< B's origin in W [m]
  Twist twist;                                      ///< in B

  bool isFinite() const {
    return orientation.coeffs().allFinite() && position.allFinite() && twist.angular.allFinite() &&
           twist.linear.allFinite();
  }
};

}  // namespace ambient
