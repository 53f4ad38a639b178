#include "demos/worlds/batch_random.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {

double RandomNumbers::uniform() noexcept {
  const std::uint64_t in_block = drawn_ % block_.size();
  if (in_block == 0)
    block_ = philox({drawn_ / block_.size(), static_cast<std::uint64_t>(place_.stream),
                     place_.episode, place_.step},
                    {place_.seed, 0});
  ++drawn_;
  return uniformOf(block_[in_block]);
}

double RandomNumbers::normal() noexcept {
  const double radius = std::sqrt(-2 * portable::log1p(-uniform()));
  return radius * portable::cos(2 * kPi * uniform());
}

}  // namespace ambient
