#pragma once

#include "bullet_ambient/spatial/frame_offset.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// The surface of the water near one body, as a plane; docs/theory.md eq. (52). In any frame, which
/// the names of such planes tell.
struct SurfacePlane {
  Vector3 normal{0, 0, 1};  ///< s, unit, out of the water
  double height = 0;        ///< h, of the plane above the frame's origin along s [m]
  double density = 0;       ///< of the water, less that of the fluid above it [kg/m^3]
  double gravity = 0;       ///< that makes the hydrostatic pressure, against s [m/s^2]

  /// zeta of a point [m], positive in the water.
  double depth(const Vector3& point) const { return height - normal.dot(point); }
  /// The same plane seen from the other fluid.
  SurfacePlane flipped() const { return {-normal, -height, density, gravity}; }
};

/// The plane in axes turned by the rotation, and about an origin at `position` [m]: from W to B for
/// the pose of B in W, from B to F for the pose of F in B.
inline SurfacePlane seenFrom(const SurfacePlane& plane, const Matrix3& rotation,
                             const Vector3& position) {
  return {rotation.transpose() * plane.normal, plane.depth(position), plane.density, plane.gravity};
}
inline SurfacePlane seenFrom(const SurfacePlane& plane, const FrameOffset& frame) {
  return seenFrom(plane, frame.rotation, frame.translation);
}

/// Two unit vectors that make a right-handed frame with a third one, in this order.
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
