#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Contribution of one patch of the body's surface to the added mass, docs/theory.md eq. (60). Used
/// for bodies that the surface of the water cuts. Per unit density, in frame F.
struct AddedMassPart {
  static constexpr int kNumbers = 30;  ///< numbers per part in files
  Vector3 centre{0, 0, 0};             ///< centroid of the patch [m]
  Vector6 spread = Vector6::Zero();    ///< xx, yy, zz, xy, xz, yz: mean of r r^T about centre [m^2]
  Matrix6 inertia = Matrix6::Zero();   ///< -sym int g phi^T dA about F's origin
};

/// Returns the image of a part whose axes, as bits, are turned.
AddedMassPart imageOf(AddedMassPart part, int turned);

/// Parts of a shape's added mass, kept in the blocks that kernels read: rounded to single
/// precision, 128 bytes per part. Of parts that planes across axes through F's origin mirror, to
/// the last bit, one of all images is kept.
class AddedMassParts {
 public:
  AddedMassParts() = default;
  /// Takes the upper triangles of the inertias. Cost: O(N log N), 0.5 us per part.
  AddedMassParts(const std::vector<AddedMassPart>& parts);

  bool empty() const { return places_.empty(); }
  std::size_t size() const { return places_.size(); }
  /// Returns a part, in the order of those that were given.
  AddedMassPart operator[](std::size_t i) const;
  std::vector<AddedMassPart> all() const;
  /// Sum of all parts: the added mass up to discretisation.
  Matrix6 sum() const;
  PartBlocks blocks() const { return {blocks_.data(), blocks_.size(), mirrors_}; }
  /// Returns those of the shape enlarged about F's origin. Cost: that of making them.
  AddedMassParts scaled(double factor) const;

 private:
  /// Packs the parts that are kept, whose numbers stand in `places_`.
  void pack(const std::vector<AddedMassPart>& parts);
  AddedMassPart unpacked(std::uint32_t place) const;

  int mirrors_ = 0;  ///< as PartBlocks::mirrors
  /// Code of each part: eight times the place of the part that is kept for it, plus the axes, as
  /// bits, by which it is that part's image.
  std::vector<std::uint32_t> places_;
  std::vector<PartBlock> blocks_;
};

/// Returns an order of the indices 0 to N - 1 in which points that are close form blocks of
/// `block_size`. Halves the set across its widest coordinate down to one block; indices within a
/// block ascend. The last block may be smaller. Cost: O(N log N).
std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector6>& coordinates,
                                         std::size_t block_size);
std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector3>& places,
                                         std::size_t block_size);

}  // namespace ambient
