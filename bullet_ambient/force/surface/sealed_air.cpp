#include "bullet_ambient/force/surface/sealed_air.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

double SealedAir::productAfter(double taken, double level, const Outside& outside) const noexcept {
  const double left = volume - taken;
  AMBIENT_ASSERT(outside.atmosphere > 0 && outside.weight > 0);
  double after = product;
  if (most < std::numeric_limits<double>::infinity())
    after = std::min(after, most * std::max(left, kept));
  if (inlet < std::numeric_limits<double>::infinity()) {
    const double cover = std::max(0.0, level - inlet);
    after = std::max(after, (outside.atmosphere - outside.weight * cover) * left);
  }
  return after;
}

double SealedAir::headAfter(double taken, double level, const Outside& outside) const noexcept {
  const double left = std::max(volume - taken, std::numeric_limits<double>::min());
  const double pressure = productAfter(volume - left, level, outside) / left;
  return (pressure - outside.atmosphere) / outside.weight;
}

}  // namespace ambient
