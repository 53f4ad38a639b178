#include "bullet_ambient/force/single_loads.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/fifth_root.h"
#include "bullet_ambient/force/single_sums.h"

namespace ambient {
namespace {

SumBlocks fastestSumBlocks() noexcept {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2})
    if (const SumBlocks sum_blocks = sumBlocksFor(set)) return sum_blocks;
  return sumBlocksBaseline;
}

// A power of two at or above the size of a motion [m/s]; 1 for rest and what is not finite.
double speedUnit(const Vector3& turning, const Vector3& linear) noexcept {
  const double largest = std::max(turning.cwiseAbs().maxCoeff(), linear.cwiseAbs().maxCoeff());
  if (!(largest > 0) || !std::isfinite(largest)) return 1;
  return std::ldexp(1.0, std::clamp(std::ilogb(largest) + 1, -1000, 1000));
}

Wrench scaled(const double (&sums)[6], double factor, double length) noexcept {
  const double turning = factor * length;
  return {{turning * sums[0], turning * sums[1], turning * sums[2]},
          {factor * sums[3], factor * sums[4], factor * sums[5]}};
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

FaceLoads computeFaceLoads(const PackedFaces& faces, double reference_length,
                           const Twist& relative_twist, const LoadSettings& settings) noexcept {
  static const SumBlocks sum_blocks = fastestSumBlocks();
  const double length = faces.lengthUnit();
  const Vector3 turning = length * relative_twist.angular;
  const double speed = speedUnit(turning, relative_twist.linear);
  const Eigen::Vector3f w = (turning / speed).cast<float>();
  const Eigen::Vector3f v = (relative_twist.linear / speed).cast<float>();
  const double cosine = settings.separation_cosine;
  const SingleMotion motion{{w.x(), w.y(), w.z()},
                            {v.x(), v.y(), v.z()},
                            static_cast<float>(-cosine * std::abs(cosine)),
                            static_cast<float>(1 - cosine * cosine)};
  // The Reynolds number of a face that slips with the unit of speed.
  const double reynolds =
      settings.viscosity > 0 ? settings.density * speed * reference_length / settings.viscosity : 0;
  const bool with_friction = settings.skin_friction && reynolds > 0;

  const FaceSums sums =
      sum_blocks(faces.blocks().data(), faces.blocks().size(), motion, with_friction);
  const double pressure = -0.5 * settings.density * speed * speed * faces.areaUnit();
  FaceLoads loads;
  loads.pressure = scaled(sums.pressure, pressure, length);
  if (with_friction)
    loads.friction = scaled(sums.friction, pressure * 0.0576 * inverseFifthRoot(reynolds), length);
  return loads;
}

}  // namespace ambient
