#include "bullet_ambient/motion/surface_passage.h"

#include <algorithm>
#include <cmath>

namespace ambient {
namespace {

/// The share of the momentum that goes into spray and shed water: theta sigma of docs/theory.md
/// eq. (67), in [-1, 1].
double sprayShare(const SurfacePassage& p, const Vector6& x) noexcept {
  const Vector3 v = Twist::fromVector(x).at(p.centre_of_buoyancy);
  const double sinking = -p.normal.dot(v), speed = v.norm();
  const double still = sinking * sinking + p.gravity * p.draught;
  if (!(speed > 0) || !(still > 0) || !(p.draught > 0)) return 0;
  const double theta =
      sinking * sinking / still * std::clamp(1 - 4 * std::max(0.0, p.cover) / p.draught, 0.0, 1.0);
  return theta * std::clamp(2 * sinking / speed, -1.0, 1.0);
}

/// F_K dt, the force so that the power is that of the change of the inertia, where the two are
/// near. The torque belongs to the gyroscopic terms of the flow, as it is.
Wrench impulseOf(const SurfacePassage& p, const Vector6& x) noexcept {
  constexpr double kMostCorrection = 3;
  const double work = p.duration * power(p.gradient, Twist::fromVector(x));
  const double ratio = 0.5 * x.dot((p.after - p.before) * x) / work;
  const bool is_near = ratio > 0 && ratio < kMostCorrection;
  return p.duration * Wrench{p.gradient.torque, (is_near ? ratio : 1) * p.gradient.force};
}

}  // namespace

BoundedTwist passSurface(const SurfacePassage& p, const Vector6& x) noexcept {
  constexpr double kRounding = 1e-12;
  const double change = (p.after - p.before).cwiseAbs().maxCoeff();
  if (change < kRounding * p.before.cwiseAbs().maxCoeff()) return {x};
  Wrench impulse = impulseOf(p, x);
  const double lost = sprayShare(p, x) * std::max(0.0, -p.normal.dot(impulse.force));
  impulse += -lost * Wrench::ofForceAt(-p.normal, p.centre_of_buoyancy);
  const Vector6 momentum = p.before * x;
  const Vector6 end = p.inverse_after * (momentum + impulse.vector());
  return scaledWithin(end, end.dot(p.after * end), x.dot(momentum));
}

}  // namespace ambient
