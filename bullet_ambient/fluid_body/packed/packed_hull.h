#pragma once

#include <array>
#include <vector>

#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Shape for hydrostatics, in frame F: surface triangles in blocks of neighbours with their
/// moments, 110 bytes per triangle. The triangles are those of SurfaceForm::hull. A sheet has
/// corners but no triangles: it displaces nothing.
class PackedHull {
 public:
  /// Cost: O(T log T). @throws std::invalid_argument as requirePrepared().
  explicit PackedHull(const FluidBody& body);
  /// Packs the triangles of a closed surface, such as that of a hold.
  explicit PackedHull(const Surface& surface);

  HullBlocks blocks() const { return {blocks_.data(), moments_.data(), blocks_.size()}; }
  HullCorners corners() const { return {points_.data(), points_.size()}; }
  /// FluidBody::volume over the volume inside the triangles; above 1 for meshes of round bodies.
  double volumeFactor() const { return volume_factor_; }

 private:
  using Triangle = std::array<Vector3, 3>;
  void packInBlocks(const std::vector<Triangle>& triangles);
  void packTriangles(const std::vector<Triangle>& triangles);
  void packPoints(const std::vector<Vector3>& points);

  std::vector<HullBlock> blocks_;
  std::vector<HullMoments> moments_;
  std::vector<HullPoints> points_;
  double volume_factor_ = 1;
};

}  // namespace ambient
