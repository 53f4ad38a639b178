// The part of LinkDynamics that solves for accelerations: articulated inertias.
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/links/link_dynamics.h"

namespace ambient {
namespace {

// Inverse of a symmetric matrix of the first `count` rows; false if it is not positive definite.
bool invert(const Matrix3& D, int count, Matrix3& inverse) {
  if (count == 1) {
    inverse(0, 0) = 1 / D(0, 0);
    return D(0, 0) > 0 && std::isfinite(inverse(0, 0));
  }
  const Cholesky<3> factor(D);
  inverse = factor.inverse();
  return factor.isPositive() && inverse.allFinite();
}

}  // namespace

bool LinkDynamics::factor() noexcept {
  for (LinkState& link : links_) link.articulated = link.inertia;
  return articulate();
}

bool LinkDynamics::factor(const std::vector<double>& drag) noexcept {
  AMBIENT_ASSERT(drag.size() == links_.size());
  for (std::size_t l = 0; l < links_.size(); ++l)
    links_[l].articulated = (1 + drag[l]) * links_[l].inertia;
  return articulate();
}

bool LinkDynamics::articulate() noexcept {
  bool is_positive = true;
  for (std::size_t l = links_.size() - 1; l > 0; --l) {
    LinkState& link = links_[l];
    if (link.is_kept) continue;
    is_positive = takeOutJoint(link) && is_positive;
    LinkState& parent = links_[link.parent];
    if (!parent.is_kept) parent.articulated += link.articulated.toB(link.offset);
  }
  if (links_[0].is_kept) return is_positive;
  base_ = Cholesky<6>(links_[0].articulated.matrix());
  return is_positive && base_.isPositive();
}

void LinkDynamics::holdJoints() noexcept {
  for (LinkState& link : links_) link.articulated = link.inertia;
  for (std::size_t l = links_.size() - 1; l > 0; --l)
    links_[links_[l].parent].articulated += links_[l].articulated.toB(links_[l].offset);
  base_ = Cholesky<6>(links_[0].articulated.matrix());
}

Vector6 LinkDynamics::answerHeld(const Vector6& momentum) const noexcept {
  const Matrix3& R = links_[0].rotation_W;
  Vector6 result;
  result << R.transpose() * momentum.head<3>(), R.transpose() * momentum.tail<3>();
  result = base_.solve(result);
  result.head<3>() = (R * result.head<3>()).eval();
  result.tail<3>() = (R * result.tail<3>()).eval();
  return result;
}

// I - I S (S^T I S)^-1 S^T I: what is left of the subtree's inertia where its joint gives way.
bool LinkDynamics::takeOutJoint(LinkState& link) noexcept {
  if (link.axes == 0) return true;
  Matrix3 D;
  for (int i = 0; i < link.axes; ++i) {
    link.push[i] = link.articulated.wrench(link.axis[i]);
    for (int j = 0; j <= i; ++j) D(i, j) = D(j, i) = power(link.push[i], link.axis[j]);
    link.weight[i] = D(i, i);
  }
  const bool is_positive = invert(D, link.axes, link.inverse);
  for (int i = 0; i < link.axes; ++i) {
    Wrench part = link.inverse(i, 0) * link.push[0];
    for (int j = 1; j < link.axes; ++j) part += link.inverse(i, j) * link.push[j];
    link.articulated.subtractProduct(link.push[i], part);
  }
  return is_positive;
}

double LinkDynamics::roughNormSquared(const CoordinatesIn& u) const noexcept {
  const LinkState& base = links_[0];
  double sum = 0;
  if (!base.is_kept) {
    sum = (base.articulated.rotation.trace() * u.head<3>().squaredNorm() +
           base.articulated.translation.trace() * u.segment<3>(3).squaredNorm()) /
          3;
  }
  for (const LinkState& link : links_) {
    if (link.is_kept) continue;
    for (int i = 0; i < link.axes; ++i)
      sum += link.weight[i] * u[link.first + i] * u[link.first + i];
  }
  return sum;
}

void LinkDynamics::accelerations(const CoordinatesIn& u, CoordinatesOut result) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_ && result.size() == coordinates_);
  computeForces(u.data(), nullptr);
  takeJointForces();
  solve(result.data());
}

void LinkDynamics::correctAccelerations(const CoordinatesIn& u,
                                        CoordinatesOut accelerations) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_ && accelerations.size() == coordinates_);
  computeForces(u.data(), accelerations.data());
  takeJointForces();
  solve(missing_.data());
  accelerations += missing_;
}

void LinkDynamics::takeJointForces() noexcept {
  for (std::size_t l = 1; l < links_.size(); ++l)
    for (int i = 0; i < links_[l].axes; ++i) links_[l].rest[i] = tree_.links[l].joint_force[i];
}

void LinkDynamics::respond(const CoordinatesIn& force, CoordinatesOut response) noexcept {
  AMBIENT_ASSERT(force.size() == coordinates_ && response.size() == coordinates_);
  for (LinkState& link : links_) {
    link.force = {Vector3::Zero(), Vector3::Zero()};
    for (int i = 0; i < link.axes; ++i) link.rest[i] = force[link.first + i];
  }
  LinkState& base = links_[0];
  base.force = {base.rotation_W.transpose() * -force.head<3>(),
                base.rotation_W.transpose() * -force.segment<3>(3)};
  solve(response.data());
}

void LinkDynamics::respond(const std::vector<Wrench>& wrenches, CoordinatesOut response) noexcept {
  AMBIENT_ASSERT(wrenches.size() == links_.size());
  AMBIENT_ASSERT(response.size() == coordinates_);
  for (std::size_t l = 0; l < links_.size(); ++l) {
    links_[l].force = -1.0 * wrenches[l];
    links_[l].rest.setZero();
  }
  solve(response.data());
}

// Accelerations, in `result`, of links at rest that need `force` and whose joints get `rest`.
void LinkDynamics::solve(double* result) noexcept {
  for (std::size_t l = links_.size() - 1; l > 0; --l) {
    LinkState& link = links_[l];
    if (link.is_kept) continue;
    for (int i = 0; i < link.axes; ++i) link.rest[i] -= power(link.force, link.axis[i]);
    for (int i = 0; i < link.axes; ++i)
      for (int j = 0; j < link.axes; ++j)
        link.force += link.inverse(i, j) * link.rest[j] * link.push[i];
    links_[link.parent].force += link.offset.toB(link.force);
  }
  solveBase(result);
  for (std::size_t l = 1; l < links_.size(); ++l) {
    LinkState& link = links_[l];
    link.acceleration = link.offset.toF(links_[link.parent].acceleration);
    if (link.is_kept) {
      for (int i = 0; i < link.axes; ++i) result[link.first + i] = 0;
      continue;
    }
    Vector3 rest;
    for (int i = 0; i < link.axes; ++i)
      rest[i] = link.rest[i] - power(link.push[i], link.acceleration);
    for (int i = 0; i < link.axes; ++i) {
      double q = 0;
      for (int j = 0; j < link.axes; ++j) q += link.inverse(i, j) * rest[j];
      result[link.first + i] = q;
      link.acceleration.angular += q * link.axis[i].angular;
      link.acceleration.linear += q * link.axis[i].linear;
    }
  }
}

void LinkDynamics::solveBase(double* result) noexcept {
  LinkState& base = links_[0];
  Vector6 a = Vector6::Zero();
  if (!base.is_kept) {
    a = base_.solve(-base.force.vector());
  }
  base.acceleration = Twist::fromVector(a);
  for (int i = 0; i < 2; ++i) {
    const Vector3 a_W = base.rotation_W * a.segment<3>(3 * i);
    for (int k = 0; k < 3; ++k) result[3 * i + k] = a_W[k];
  }
}

}  // namespace ambient
