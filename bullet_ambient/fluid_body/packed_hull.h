#pragma once

#include <array>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/hull_block.h"

namespace ambient {

/// What hydrostatics needs of a shape, in frame F: the triangles of its surface in blocks of
/// neighbours with their moments, 140 bytes per triangle. Flat sides with a convex outline are a
/// fan of few triangles, however they were meshed. A sheet has none: it displaces nothing.
class PackedHull {
 public:
  /// Cost: O(T log T), 2 us per triangle.
  explicit PackedHull(const FluidBody& body);

  HullBlocks blocks() const { return {blocks_.data(), moments_.data(), blocks_.size()}; }
  HullCorners corners() const { return {points_.data(), points_.size()}; }
  /// Volume of the body over that of its triangles: a mesh of a round body may be a little smaller.
  double volumeFactor() const { return volume_factor_; }

 private:
  using Triangle = std::array<Vector3, 3>;
  void packTriangles(const std::vector<Triangle>& triangles);
  void packPoints(const std::vector<Vector3>& points);

  std::vector<HullBlock> blocks_;
  std::vector<HullMoments> moments_;
  std::vector<HullPoints> points_;
  double volume_factor_ = 1;
};

}  // namespace ambient
