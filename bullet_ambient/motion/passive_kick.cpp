#include "bullet_ambient/motion/passive_kick.h"

#include "bullet_ambient/motion/passive_kick_kernel.h"

namespace ambient {
namespace {

Vectors inAllLanes(double x, double y, double z) { return {all(x), all(y), all(z)}; }
Spatials inAllLanes(const Vector6& a) {
  return {inAllLanes(a[0], a[1], a[2]), inAllLanes(a[3], a[4], a[5])};
}
Pairs inAllLanes(const DualPair& a) { return {inAllLanes(a.twist), inAllLanes(a.momentum)}; }

Vector6 ofFirstLane(const Spatials& a) {
  Vector6 x;
  x << a.angular.x[0], a.angular.y[0], a.angular.z[0], a.linear.x[0], a.linear.y[0], a.linear.z[0];
  return x;
}

}  // namespace

DualPair passiveKick(const DualPair& x, const LoadSample& sample, double duration) noexcept {
  const Pairs end =
      passiveKick(inAllLanes(x), inAllLanes(sample.motion), inAllLanes(sample.load), all(duration));
  return {ofFirstLane(end.twist), ofFirstLane(end.momentum)};
}

}  // namespace ambient
