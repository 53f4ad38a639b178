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

using Products = Eigen::Matrix<double, 21, 1>;

// x_i x_j, i <= j, in the order of LoadLevel::even.
Products productsOf(const Vector6& x) noexcept {
  Products products;
  int next = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) products[next++] = x[i] * x[j];
  return products;
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

FaceLoads computeLevelLoads(const LoadLevel& level, double reference_length,
                            const Twist& relative_twist, const LoadSettings& settings) noexcept {
  static const SumClusters sum_clusters = fastestSumClusters();
  const double length = level.length;
  const ScaledMotion motion =
      scaledMotion(relative_twist.angular, relative_twist.at(level.centre), length);
  const double reynolds = frictionReynolds(settings, motion.speed, reference_length);
  FaceSums sums = sum_clusters(level.blocks.data(), level.blocks.size(),
                               singleMotion(motion, settings.separation_cosine), reynolds > 0);
  Vector6 x;
  x << motion.angular, motion.linear;
  const Vector6 even = level.even * productsOf(x);
  for (int row = 0; row < 6; ++row) sums.pressure[row] += even[row];
  FaceLoads loads = scaledLoads(sums, settings, motion.speed, length * length, length, reynolds);
  for (Wrench* wrench : {&loads.pressure, &loads.friction})
    wrench->torque += level.centre.cross(wrench->force);
  return loads;
}

}  // namespace ambient
