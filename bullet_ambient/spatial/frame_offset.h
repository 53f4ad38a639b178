#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

struct Twist;
struct Wrench;

/// Pose of frame F in frame B: p_B = rotation p_F + translation [m].
struct FrameOffset {
  Matrix3 rotation{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vector3 translation{0, 0, 0};

  bool isIdentity() const { return rotation.isIdentity(0) && translation.isZero(0); }
  /// The twist of the same rigid body at F's origin in F's axes, given at B's origin in B's axes.
  Twist toF(const Twist& x_B) const;
  /// The wrench about B's origin in B's axes, given about F's origin in F's axes.
  Wrench toB(const Wrench& f_F) const;
  /// Inertia about B's origin in B's axes, given about F's origin in F's axes.
  Matrix6 inertiaToB(const Matrix6& inertia_F) const;
};

}  // namespace ambient
