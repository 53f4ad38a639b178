#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/face_block.h"
#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// The faces of a shape for loads in single precision: 40 bytes per face, in frame F. The units are
/// powers of two, so that a shape of any size that is a power of two times another has the same
/// bits.
class PackedFaces {
 public:
  explicit PackedFaces(const FaceTable& faces);

  /// Whether it was made of these very faces. Cost O(F), as much as making it.
  bool isOf(const FaceTable& faces) const;

  const std::vector<FaceBlock>& blocks() const { return blocks_; }
  std::size_t size() const { return size_; }
  double lengthUnit() const { return length_unit_; }  ///< [m]
  double areaUnit() const { return area_unit_; }      ///< [m^2]

 private:
  std::vector<FaceBlock> blocks_;
  std::size_t size_ = 0;
  double length_unit_ = 1, area_unit_ = 1;
};

/// The packed faces of a table: made at the first call, and shared by all who ask for those of the
/// same table while any of them lives. May be called from several threads. Cost O(F), some ns per
/// face.
std::shared_ptr<const PackedFaces> sharedPackedFaces(const FaceTable& faces);

}  // namespace ambient
