#include "bullet_ambient/motion/links/link_integrals.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

constexpr double kLargestFactor = 1.5;  // largest factor on a velocity; its inverse is the smallest

bool isModest(double factor) { return factor < kLargestFactor && factor * kLargestFactor > 1; }

}  // namespace

LinkIntegrals::LinkIntegrals(const LinkTree& tree)
    : tree_(tree), flow_(coordinateCount(tree)), x_(flow_), momenta_(flow_) {}

void LinkIntegrals::take(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept {
  AMBIENT_ASSERT(u.size() == flow_.size());
  is_known_ = findFlow(tree_, u, flow_);
  floats_ = !tree_.links[0].keeps_velocity;
  x_ = u - flow_;
  dynamics.momentum(x_, momenta_);
  momentum_ = momenta_.head<6>();
  energy_ = momenta_.dot(x_);
  reference_ = dynamics.position(0);
}

void LinkIntegrals::addForces(LinkDynamics& dynamics, const CoordinatesIn& u, double h) noexcept {
  AMBIENT_ASSERT(h > 0 && u.size() == flow_.size());
  dynamics.appliedForces(momenta_);
  x_ = u - flow_;
  energy_ += 2 * h * momenta_.dot(x_);
  const Vector3 way = h / 2 * flow_.segment<3>(3), force = momenta_.segment<3>(3);
  momentum_.head<3>() +=
      h * (momenta_.head<3>() + (dynamics.position(0) - reference_ - way).cross(force));
  momentum_.tail<3>() += h * force;
  reference_ += 2 * way;
}

Vector6 LinkIntegrals::momentumAbout(const Vector3& point_W) const noexcept {
  Vector6 result = momentum_;
  result.head<3>() += (reference_ - point_W).cross(momentum_.tail<3>());
  return result;
}

double LinkIntegrals::impose(LinkDynamics& dynamics, CoordinatesOut u, bool is_coarse) noexcept {
  if (!is_known_ && !is_coarse) return 0;
  x_ = u - flow_;
  dynamics.momentum(x_, momenta_);
  const double has = momenta_.dot(x_);
  if (is_known_ && floats_) {
    const Vector6 its = momenta_.head<6>(), wanted = momentumAbout(dynamics.position(0));
    dynamics.holdJoints();
    const Vector6 held = dynamics.answerHeld(its), base = dynamics.answerHeld(wanted);
    const double factor =
        std::sqrt((energy_ - wanted.dot(base)) / std::max(0.0, has - its.dot(held)));
    if (isModest(factor)) {
      u = flow_ + factor * x_;
      u.head<6>() += base - factor * held;
      return 0;
    }
  }
  const double factor = std::sqrt(std::max(0.0, energy_) / has);
  if (factor < 1 || (is_known_ && isModest(factor))) u = flow_ + factor * x_;
  return !is_known_ && factor < 1 ? (1 - factor * factor) * has / 2 : 0;
}

void LinkIntegrals::imposeMomentum(LinkDynamics& dynamics, CoordinatesOut u) noexcept {
  if (!is_known_ || !floats_) return;
  x_ = u - flow_;
  dynamics.momentum(x_, momenta_);
  dynamics.holdJoints();
  u.head<6>() += dynamics.answerHeld(momentumAbout(dynamics.position(0)) - momenta_.head<6>());
}

}  // namespace ambient
