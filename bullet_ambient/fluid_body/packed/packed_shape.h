#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Returns a vertex of a surface, in its frame [m].
inline Vector3 vertexOf(const Surface& surface, std::int32_t vertex) {
  return Vector3(&surface.vertices[3 * static_cast<std::size_t>(vertex)]);
}

/// Faces of a shape for loads in single precision: 49 bytes per face, in frame F. Units are powers
/// of two: shapes whose sizes differ by a power of two have the same bits. Faces with similar
/// normal and place share a block. A block is skipped if the flow is detached from all its faces.
/// The factors of the form law take 16 bytes more.
class PackedFaces {
 public:
  /// Packs for the published law. Cost: O(F log F), 0.1 us per face.
  explicit PackedFaces(const FaceTable& faces);
  /// Packs for the form law. @pre faces.sharpness is filled
  PackedFaces(const FaceTable& faces, const FormShape& shape);

  FaceBlocks blocks() const {
    return {blocks_.data(), bounds_.data(), blocks_.size(), form_.empty() ? nullptr : form_.data(),
            lee_.data()};
  }
  std::size_t size() const { return order_.size(); }
  double lengthUnit() const { return length_unit_; }  ///< [m]
  double areaUnit() const { return area_unit_; }      ///< [m^2]

 private:
  FaceBlock packBlock(const FaceTable& faces, std::size_t block) const;
  void setBounds(std::size_t block);
  void setPlace(std::size_t block);
  void packForm(const FaceTable& faces, const FormShape& shape);
  void addLee(const FaceTable& faces, std::size_t face, double by_lee);

  std::vector<std::uint32_t> order_;  ///< index into FaceTable of each face in the blocks
  std::vector<FaceBlock> blocks_;
  std::vector<FaceBounds> bounds_;
  std::vector<FormBlock> form_;
  std::vector<double> lee_;  ///< 6 x 21, column by column
  double length_unit_ = 1, area_unit_ = 1;
};

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
