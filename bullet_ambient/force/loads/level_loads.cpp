#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/kernels/level_sums.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/single_motion.h"

namespace ambient {
Wrench computeLevelLoad(const LoadLevel& level, double reference_length,
                        const Twist& relative_twist, const LoadSettings& settings) noexcept {
  static const SumClusters sum_clusters = kSumClusters.fastest();
  const double length = level.length;
  AMBIENT_ASSERT(length > 0 && settings.density >= 0);
  const ScaledMotion motion =
      scaledMotion(relative_twist.angular, relative_twist.at(level.centre), length);
  const Vector3 &w = motion.angular, &v = motion.linear;
  const LoadSums sums = sum_clusters({level.blocks.data(), level.blocks.size(), level.even.data()},
                                     {w.x(), w.y(), w.z(), v.x(), v.y(), v.z()},
                                     singleMotion(motion, settings, reference_length));
  Wrench load = scaledLoad(sums, settings.density, motion.unit.speed, length * length, length);
  load.torque += level.centre.cross(load.force);
  return load;
}

}  // namespace ambient
