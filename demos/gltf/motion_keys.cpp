#include "demos/gltf/motion_keys.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "demos/simulation/output/motion_interpolation.h"

namespace ambient {
namespace {

constexpr double kLargestTurn = 0.785;  // an eighth of a turn [rad]

int countPieces(const MotionSample& from, const MotionSample& to) {
  const double spin = std::max(from.twist.angular.norm(), to.twist.angular.norm());
  return std::max(1, static_cast<int>(std::ceil(spin * (to.time - from.time) / kLargestTurn)));
}

}  // namespace

std::vector<MotionSample> makeMotionKeys(const std::vector<MotionSample>& motion) {
  std::vector<MotionSample> keys;
  for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
    const MotionSample &from = motion[i], &to = motion[i + 1];
    AMBIENT_ASSERT(from.time < to.time);
    const int pieces = countPieces(from, to);
    for (int k = 0; k < pieces; ++k)
      appendSample(keys,
                   interpolateMotion(from, to, from.time + (to.time - from.time) * k / pieces));
  }
  if (!motion.empty()) appendSample(keys, motion.back());
  return keys;
}

}  // namespace ambient
