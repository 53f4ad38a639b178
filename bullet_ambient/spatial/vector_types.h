#pragma once

#include <Eigen/Core>

namespace ambient {

// Fixed-size types of the numeric core. They are never over-aligned: programs compiled with other
// instruction-set flags than this library have the same layout of every struct. Headers for users
// write zeros and ones out: Eigen's Zero() and Identity() add a tenth of a second to the compile
// time of each user source. Cross products and the members of Quaternion need Eigen/Geometry,
// which spatial_vectors.h includes.
using Vector3 = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

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
