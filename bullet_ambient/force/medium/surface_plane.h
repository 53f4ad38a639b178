#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Vertical planes at which the water around a body ends: sides of a pool that cut the body,
/// docs/theory.md section 17. In the frame of the fluid body F.
struct PoolSides {
  static constexpr int kMost = 4;  // a box has four vertical sides
  struct Side {
    Vector3 normal{0, 0, 0};  ///< unit, out of the pool
    Vector3 point{0, 0, 0};   ///< of the plane [m]
  };
  int count = 0;
  Side of[kMost];
};

/// Surface of the water near one body, as a plane; docs/theory.md eq. (52). Names of variables
/// tell the frame.
struct SurfacePlane {
  Vector3 normal{0, 0, 1};  ///< s, unit, out of the water
  double height = 0;        ///< h, height of the plane above the frame's origin along s [m]
  double density = 0;       ///< density of the water minus that of the fluid above [kg/m^3]
  double gravity = 0;       ///< g = |g - a_fluid| of the hydrostatic pressure, against s [m/s^2]
  /// Where the water ends beside the body, in F whatever the frame of the plane; null: nowhere. Not
  /// owned.
  const PoolSides* sides_F = nullptr;

  /// Depth zeta of a point [m], positive in the water.
  double depth(const Vector3& point) const { return height - normal.dot(point); }
  /// Same plane with the normal out of the upper fluid, which ends nowhere.
  SurfacePlane flipped() const { return {-normal, -height, density, gravity}; }
};

/// Converts a plane to another frame, whose pose is given by `rotation` and `position` [m]. The
/// pose of B in W converts from W to B; the pose of F in B converts from B to F.
inline SurfacePlane seenFrom(const SurfacePlane& plane, const Matrix3& rotation,
                             const Vector3& position) {
  return {rotation.transpose() * plane.normal, plane.depth(position), plane.density, plane.gravity,
          plane.sides_F};
}
inline SurfacePlane seenFrom(const SurfacePlane& plane, const FrameOffset& frame) {
  return seenFrom(plane, frame.rotation, frame.translation);
}

/// Part of a body that is in the fluid.
struct WetPart {
  SurfacePlane plane;  ///< surface of the fluid, in the frame of the loads
  double share = 1;    ///< share of the body's volume in the fluid
};

/// Two unit vectors in a plane: first x second = normal.
struct PlaneAxes {
  Vector3 first, second;

  explicit PlaneAxes(const Vector3& normal) {
    Eigen::Index least = 0;
    normal.cwiseAbs().minCoeff(&least);
    first = Vector3::Unit(least).cross(normal).normalized();
    second = normal.cross(first);
  }
};

}  // namespace ambient
