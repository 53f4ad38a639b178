#include "bullet_ambient/force/single_loads.h"

#include "bullet_ambient/force/single_motion.h"

namespace ambient {
namespace {

SumBlocks fastestSumBlocks() noexcept {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2})
    if (const SumBlocks sum_blocks = sumBlocksFor(set)) return sum_blocks;
  return sumBlocksBaseline;
}

}  // namespace

SumBlocks sumBlocksFor(InstructionSet instruction_set) noexcept {
#if defined(__x86_64__)
  if (instruction_set == InstructionSet::kAvx512)
    return sumFacesFor(instruction_set) ? sumBlocksAvx512 : nullptr;
  if (instruction_set == InstructionSet::kAvx2)
    return sumFacesFor(instruction_set) ? sumBlocksAvx2 : nullptr;
#endif
  return instruction_set == InstructionSet::kBaseline ? sumBlocksBaseline : nullptr;
}

Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings) noexcept {
  static const SumBlocks sum_blocks = fastestSumBlocks();
  const double length = faces.lengthUnit();
  const ScaledMotion motion = scaledMotion(relative_twist.angular, relative_twist.linear, length);
  const LoadSums sums =
      sum_blocks(faces.blocks(), singleMotion(motion, settings, reference_length));
  return scaledLoad(sums, settings.density, motion.unit.speed, faces.areaUnit(), length);
}

}  // namespace ambient
