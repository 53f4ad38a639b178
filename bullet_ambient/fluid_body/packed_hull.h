#pragma once

#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/hull_block.h"

namespace ambient {

/// What hydrostatics needs of a shape, in frame F: the triangles of its surface in blocks of
/// neighbours with their moments, 130 bytes per triangle. A sheet has none: it displaces nothing.
class PackedHull {
 public:
  /// Cost: O(T log T), 1 us per triangle.
  explicit PackedHull(const FluidBody& body);

  HullBlocks blocks() const { return {blocks_.data(), moments_.data(), blocks_.size()}; }
  /// Volume of the body over that of its triangles: a mesh of a round body may be a little smaller.
  double volumeFactor() const { return volume_factor_; }
  /// Least and largest s.z over the body [m], for a unit vector s. Cost: 2 ns per block, and the
  /// corners of few.
  std::pair<double, double> extent(const Vector3& direction) const noexcept;

 private:
  void packTriangles(const FluidBody& body);
  void packPoints(const std::vector<Vector3>& points);

  /// Sixteen corners in a sphere.
  struct PointBlock {
    Vector3 centre;
    double radius;
    std::size_t begin, end;  ///< of points_
  };
  double farthest(const Vector3& direction) const noexcept;

  std::vector<HullBlock> blocks_;
  std::vector<HullMoments> moments_;
  std::vector<Vector3> points_;
  std::vector<PointBlock> point_blocks_;
  double volume_factor_ = 1;
};

}  // namespace ambient
