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
  /// Converts the twist of a rigid body from B's origin and axes to F's origin and axes.
  Twist toF(const Twist& x_B) const;
  /// Converts a wrench from F's origin and axes to B's origin and axes.
  Wrench toB(const Wrench& f_F) const;
  /// Converts a 6x6 inertia from F's origin and axes to B's origin and axes; eq. (4), (5).
  Matrix6 inertiaToB(const Matrix6& inertia_F) const;
};

}  // namespace ambient
