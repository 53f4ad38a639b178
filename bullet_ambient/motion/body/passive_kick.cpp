#include "bullet_ambient/motion/body/passive_kick.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"

namespace ambient {

DualPair passiveKick(const DualPair& x, const LoadSample& sample, double duration) noexcept {
  AMBIENT_ASSERT(duration >= 0);
  const Pairs end =
      passiveKick(inAllLanes(x), inAllLanes(sample.motion), inAllLanes(sample.load), all(duration));
  return {ofFirstLane(end.twist), ofFirstLane(end.momentum)};
}

}  // namespace ambient
