#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/share_in_pool.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/single_motion.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/invariants.h"

namespace ambient {
namespace {

SingleCut cutBy(const SurfacePlane& plane, const PackedFaces& faces) noexcept {
  const double length = faces.lengthUnit();
  AMBIENT_ASSERT(isUnit(plane.normal));
  const Eigen::Vector3f s = plane.normal.cast<float>();
  // The clamp keeps single precision finite; farther away only the side of the plane matters.
  const double height = std::clamp(plane.height / length, -1e6, 1e6);
  return {{s.x(), s.y(), s.z()},
          static_cast<float>(height),
          static_cast<float>(faces.areaUnit() / (kPi * length * length))};
}

/// Blocks that share their bounds, with the areas that are between the sides of a pool.
class BlocksInPool {
 public:
  BlocksInPool(const FaceBlocks& all, std::size_t first, const PackedFaces& faces,
               const PoolSides& sides_F)
      : blocks_{cut_, all.bounds + first / kMost, std::min(kMost, all.count - first),
                all.form ? all.form + first : nullptr, all.lee} {
    const double length = faces.lengthUnit();
    for (std::size_t i = 0; i < blocks_.count; ++i) {
      FaceBlock& block = cut_[i] = all.blocks[first + i];
      for (int k = 0; k < FaceBlock::kFaces; ++k) {
        const auto vectorOf = [k](const float(&rows)[3][FaceBlock::kFaces]) {
          return Vector3(rows[0][k], rows[1][k], rows[2][k]);
        };
        const double radius_sq = static_cast<double>(block.area[k]) * faces.areaUnit() / kPi;
        block.area[k] *= static_cast<float>(shareInPool(sides_F, length * vectorOf(block.centroid),
                                                        vectorOf(block.normal), radius_sq));
      }
    }
  }
  const FaceBlocks& operator*() const { return blocks_; }

  static constexpr std::size_t kMost = FaceBounds::kBlocks;

 private:
  FaceBlock cut_[kMost];
  FaceBlocks blocks_;
};

/// Sums all faces, or, where the water ends at the sides of a pool, what is of them in the pool.
LoadSums sumFaces(const PackedFaces& faces, const SingleMotion& motion, const PoolSides* sides_F) {
  static const SumBlocks sum_blocks = kSumBlocks.fastest();
  const FaceBlocks all = faces.blocks();
  if (!sides_F) return sum_blocks(all, motion);
  LoadSums sums{};
  for (std::size_t first = 0; first < all.count; first += BlocksInPool::kMost) {
    const LoadSums more = sum_blocks(*BlocksInPool(all, first, faces, *sides_F), motion);
    for (int i = 0; i < 6; ++i) sums.wrench[i] += more.wrench[i];
    sums.pitch += more.pitch;
  }
  return sums;
}

}  // namespace

Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings,
                       const SurfacePlane* plane) noexcept {
  AMBIENT_ASSERT(faces.size() == 0 ||
                 (settings.law == PressureLaw::kForm) == (faces.blocks().form != nullptr));
  AMBIENT_ASSERT(!settings.shape || settings.law == PressureLaw::kForm);
  AMBIENT_ASSERT(settings.density >= 0 && reference_length >= 0);
  const double length = faces.lengthUnit();
  const ScaledMotion motion = scaledMotion(relative_twist.angular, relative_twist.linear, length);
  SingleMotion single = singleMotion(motion, settings, reference_length);
  const SingleCut cut = plane ? cutBy(*plane, faces) : SingleCut{};
  if (plane) single.cut = &cut;
  if (settings.shape) addShape(*settings.shape, motion, length, settings.separation_cosine, single);
  LoadSums sums = sumFaces(faces, single, plane ? plane->sides_F : nullptr);
  if (single.wing)
    for (int axis = 0; axis < 3; ++axis)
      sums.wrench[axis] -= settings.shape->shape.pitching[axis] * sums.pitch;
  return scaledLoad(sums, settings.density, motion.unit.speed, faces.areaUnit(), length);
}

}  // namespace ambient
