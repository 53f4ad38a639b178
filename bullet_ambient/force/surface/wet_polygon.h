#pragma once

#include "bullet_ambient/force/kernels/hull_sums.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {

/// Frame of a water surface and the pool around it: e_1 and e_2 in the surface, and the depth zeta.
/// In it the sides of the pool are lines.
class PoolFrame {
 public:
  /// @pre plane.sides_F; the plane is in F
  explicit PoolFrame(const SurfacePlane& plane) noexcept;

  const PlaneAxes& axes() const { return axes_; }
  /// Returns coordinates along e_1 and e_2, and the depth as z [m].
  Vector3 seen(const Vector3& place_F) const {
    return {axes_.first.dot(place_F), axes_.second.dot(place_F), plane_.depth(place_F)};
  }
  int sides() const { return count_; }
  /// Returns how far a seen point is inside of a side of the pool [m].
  double inside(int side, const Vector3& seen) const {
    return reach_[side] - out_[side].dot(seen.head<2>());
  }

 private:
  SurfacePlane plane_;
  PlaneAxes axes_;
  int count_ = 0;
  Eigen::Vector2d out_[PoolSides::kMost];
  double reach_[PoolSides::kMost];
};

/// Part of a triangle that is below the surface and between the sides of the pool: a convex
/// polygon in the coordinates of PoolFrame.
class WetPolygon {
 public:
  WetPolygon(const PoolFrame& pool, const Vector3 (&corners_F)[3]) noexcept;

  int count() const { return count_; }  ///< number of corners; 0: nothing
  const Vector3& corner(int i) const { return corners_[i]; }
  /// Calls visit(a, b, c) for the triangles of a fan over the polygon.
  template <class Visit>
  void forEachTriangle(const Visit& visit) const {
    for (int i = 2; i < count_; ++i) visit(corners_[0], corners_[i - 1], corners_[i]);
  }

 private:
  /// Each plane that cuts a convex polygon adds at most one corner.
  static constexpr int kMost = 3 + 1 + PoolSides::kMost;
  template <class Inside>
  void cut(const Inside& inside) noexcept;

  int count_ = 3;
  Vector3 corners_[kMost];
};

/// Sums over the wet parts of a hull between the sides of a pool, as of HullKernel::sums(). Sides
/// are vertical: the cuts there add nothing, docs/theory.md eq. (89). Cost: O(triangles), 0.1 us
/// each.
HullSums sumBetweenSides(const HullBlocks& hull, const SurfacePlane& plane_F) noexcept;

/// Integrals of the depth over the cuts at the sides of the pool, out of it: int zeta (z x m, m) dA
/// [m^4, m^3], docs/theory.md eq. (90). Times rho g it is the wrench by which the water presses the
/// body out of the pool, about F's origin.
Wrench sumOverSides(const HullBlocks& hull, const SurfacePlane& plane_F) noexcept;

}  // namespace ambient
