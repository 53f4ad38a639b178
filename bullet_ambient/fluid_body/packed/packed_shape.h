#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

using HullTriangle = std::array<Vector3, 3>;

/// Returns a vertex of a surface, in its frame [m].
inline Vector3 vertexOf(const Surface& surface, std::int32_t vertex) {
  return Vector3(&surface.vertices[3 * static_cast<std::size_t>(vertex)]);
}

/// Faces of a shape for loads in single precision: 45 bytes per face, in frame F. Units are powers
/// of two: shapes whose sizes differ by a power of two have the same bits. Faces with similar
/// normal and place share a block. A block of many is skipped if the flow is detached from all its
/// faces. The form law takes 4 bytes more, 8 of a wing.
class PackedFaces {
 public:
  /// Packs for the published law. Cost: O(F log F), 0.1 us per face.
  explicit PackedFaces(const FaceTable& faces) : PackedFaces(faces, nullptr) {}
  /// Packs for the form law. @pre faces.sharpness is filled
  PackedFaces(const FaceTable& faces, const FormShape& shape) : PackedFaces(faces, &shape) {}

  FaceBlocks blocks() const {
    const auto orNull = [](const auto& all) { return all.empty() ? nullptr : all.data(); };
    return {blocks_.data(),     boxes_.data(), blocks_.size(), orNull(bounds_),
            orNull(sharpness_), orNull(arms_), orNull(lee_)};
  }
  std::size_t size() const { return size_; }
  double lengthUnit() const { return length_unit_; }  ///< [m]
  double areaUnit() const { return area_unit_; }      ///< [m^2]

 private:
  using Order = std::vector<std::uint32_t>;  // index into FaceTable of each face in the blocks

  PackedFaces(const FaceTable& faces, const FormShape* shape);
  FaceBlock packBlock(const FaceTable& faces, const Order& order, std::size_t block) const;
  std::size_t sizeOf(std::size_t block) const;
  void setBounds(std::size_t block);
  void setBox(std::size_t block);
  void packForm(const FaceTable& faces, const Order& order, const FormShape& shape);
  void addLee(const FaceTable& faces, std::size_t face, double by_lee);

  std::size_t size_;
  std::vector<FaceBlock> blocks_;
  std::vector<FaceBoxes> boxes_;
  std::vector<FaceBounds> bounds_;
  std::vector<FaceColumn> sharpness_, arms_;
  std::vector<double> lee_;  ///< 6 x 21, column by column
  double length_unit_ = 1, area_unit_ = 1;
};

/// Shape for hydrostatics, in frame F: surface triangles in blocks of neighbours with their
/// moments, 110 bytes per triangle. The triangles are those of SurfaceForm::hull; of many that are
/// alike after quarter turns about an axis through F's origin, a quarter is kept, HullSymmetry. A
/// sheet has corners but no triangles: it displaces nothing.
class PackedHull {
 public:
  /// Cost: O(T log T). @throws std::invalid_argument as requirePrepared().
  explicit PackedHull(const FluidBody& body);
  /// Packs the triangles of a closed surface, such as that of a hold.
  explicit PackedHull(const Surface& surface);

  HullBlocks blocks() const {
    return {blocks_.data(), boxes_.data(), moments_.data(),
            blocks_.size(), symmetry_,     whole_.get()};
  }
  HullCorners corners() const { return {points_.data(), points_.size(), symmetry_}; }
  /// FluidBody::volume over the volume inside the triangles; above 1 for meshes of round bodies.
  double volumeFactor() const { return volume_factor_; }

 private:
  void packTriangles(const std::vector<HullTriangle>& unsorted);
  void packPoints(const std::vector<Vector3>& points);

  std::vector<HullBlock> blocks_;
  std::vector<HullBoxes> boxes_;
  std::vector<HullMoments> moments_;
  std::vector<HullPoints> points_;
  HullSymmetry symmetry_;
  std::shared_ptr<const HullWhole> whole_;  ///< null: all is kept
  double volume_factor_ = 1;
};

}  // namespace ambient
