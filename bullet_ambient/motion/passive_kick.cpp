#include "bullet_ambient/motion/passive_kick.h"

#include <algorithm>
#include <cmath>

namespace ambient {

DualPair passiveKick(const DualPair& x, const LoadSample& sample, double duration) noexcept {
  const DualPair& xs = sample.motion;
  const double E = inner(xs, xs);
  if (!(E > 0)) return x;  // no motion relative to the fluid, no load
  const double n = std::sqrt(E);
  const double along = inner(xs, sample.load) / E;
  const double decay = along > 0 ? 0 : -along;  // a load that is not finite must not look like none

  // Acceleration across the motion: what is left of K^-1 F without its part along the twist.
  const DualPair across = sample.load - along * xs;
  const double f = std::sqrt(std::max(0.0, inner(across, across)));

  const double speed = std::sqrt(std::max(0.0, inner(x, x)));
  const double z = decay * duration * speed / n;
  const double log_ratio = z > 1e-8 ? std::log1p(z) / z : 1 - z / 2;
  DualPair turned = x;
  if (f > 0) {
    const double angle = duration * f / n * log_ratio * (speed / n);
    const double c1 = inner(x, xs) / n;
    const double c2 = inner(x, across) / f;
    // A rotation whatever the rounding of the tangent.
    const double t = std::tan(angle / 2);
    const double sine = 2 * t / (1 + t * t);
    const double versine = t * sine;
    turned += ((-versine * c1 - sine * c2) / n) * xs + ((sine * c1 - versine * c2) / f) * across;
  }
  return 1 / (1 + z) * turned;
}

}  // namespace ambient
