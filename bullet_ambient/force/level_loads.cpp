#include "bullet_ambient/force/level_loads.h"

#include "bullet_ambient/force/level_sums.h"
#include "bullet_ambient/force/single_motion.h"

namespace ambient {
namespace {

SumClusters fastestSumClusters() noexcept {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2})
    if (const SumClusters sum_clusters = sumClustersFor(set)) return sum_clusters;
  return sumClustersBaseline;
}

}  // namespace

SumClusters sumClustersFor(InstructionSet instruction_set) noexcept {
#if defined(__x86_64__)
  if (instruction_set == InstructionSet::kAvx512)
    return sumFacesFor(instruction_set) ? sumClustersAvx512 : nullptr;
  if (instruction_set == InstructionSet::kAvx2)
    return sumFacesFor(instruction_set) ? sumClustersAvx2 : nullptr;
#endif
  return instruction_set == InstructionSet::kBaseline ? sumClustersBaseline : nullptr;
}

Wrench computeLevelLoad(const LoadLevel& level, double reference_length,
                        const Twist& relative_twist, const LoadSettings& settings) noexcept {
  static const SumClusters sum_clusters = fastestSumClusters();
  const double length = level.length;
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
