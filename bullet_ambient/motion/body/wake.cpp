#include "bullet_ambient/motion/body/wake.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

constexpr double kWay = 1.5;        // lambda_w, diameters in which the wake follows the motion
constexpr double kDeveloped = 0.7;  // share from which on it counts as developed

/// Product of motions as velocities of points of a ball of that surface.
double product(const Twist& a, const Twist& b, double area) {
  return a.linear.dot(b.linear) + area / (4 * kPi) * a.angular.dot(b.angular);
}

}  // namespace

double developWake(const WakeStep& step, Wake& wake) noexcept {
  AMBIENT_ASSERT(step.duration >= 0 && step.area >= 0 && step.volume >= 0);
  const Twist& x = step.velocity_W;
  if (!wake.has_begun) wake = {x, true};
  const double square = product(x, x, step.area);
  const double way = step.area > 0 ? kWay * 6 * step.volume / step.area : 0;
  if (!(square > 0) || !(way > 0)) return 1;
  const double share =
      std::clamp(product(wake.velocity_W, x, step.area) / (kDeveloped * square), 0.0, 1.0);
  const double kept = portable::exp(-std::sqrt(square) * step.duration / way);
  Twist& w = wake.velocity_W;
  w = {x.angular + kept * (w.angular - x.angular), x.linear + kept * (w.linear - x.linear)};
  return share * share;
}

}  // namespace ambient
