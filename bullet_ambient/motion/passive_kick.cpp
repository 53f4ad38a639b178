#include "bullet_ambient/motion/passive_kick.h"

#include <algorithm>
#include <cmath>

namespace ambient {

Vector6 passiveKick(const BodyModel& model, const Vector6& x, const LoadSample& load,
                    double duration) noexcept {
  const Vector6 K_xs = model.inertia * load.twist;
  const double E = load.twist.dot(K_xs);
  if (!(E > 0)) return x;  // no motion relative to the fluid, no load
  const double n = std::sqrt(E);
  const double drag = -load.wrench.dot(load.twist) / E;
  const double decay = drag < 0 ? 0 : drag;  // a load that is not finite must not look like none

  // Acceleration across the motion: what is left of K^-1 F without its part along the twist.
  Vector6 across = model.inverse_inertia * load.wrench;
  across -= load.twist * (K_xs.dot(across) / E);
  const Vector6 K_across = model.inertia * across;
  const double f = std::sqrt(std::max(0.0, across.dot(K_across)));

  const double speed = std::sqrt(std::max(0.0, inertiaNormSquared(model, x)));
  const double z = decay * duration * speed / n;
  const double log_ratio = z > 1e-8 ? std::log1p(z) / z : 1 - z / 2;
  Vector6 turned = x;
  if (f > 0) {
    const double angle = duration * f / n * log_ratio * (speed / n);
    const double c1 = x.dot(K_xs) / n;
    const double c2 = x.dot(K_across) / f;
    const double sine = std::sin(angle);
    const double versine = 2 * std::sin(angle / 2) * std::sin(angle / 2);
    turned +=
        load.twist * ((-versine * c1 - sine * c2) / n) + across * ((sine * c1 - versine * c2) / f);
  }
  return turned / (1 + z);
}

}  // namespace ambient
