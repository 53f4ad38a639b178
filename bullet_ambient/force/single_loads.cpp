#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/single_motion.h"
#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {
Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings) noexcept {
  AMBIENT_ASSERT(faces.size() == 0 ||
                 (settings.law == PressureLaw::kForm) == (faces.blocks().sharpness != nullptr));
  static const SumBlocks sum_blocks = kSumBlocks.fastest();
  const double length = faces.lengthUnit();
  const ScaledMotion motion = scaledMotion(relative_twist.angular, relative_twist.linear, length);
  const LoadSums sums =
      sum_blocks(faces.blocks(), singleMotion(motion, settings, reference_length));
  return scaledLoad(sums, settings.density, motion.unit.speed, faces.areaUnit(), length);
}

}  // namespace ambient
