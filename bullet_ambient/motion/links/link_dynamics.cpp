#include "bullet_ambient/motion/links/link_dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

static_assert(sizeof(LinkState::axis) == kMaxJointAxes * sizeof(AxisPair));

AxisRow rowOf(const Vector3& a) { return AxisRow{{a[0], a[1], a[2], 0}}; }
template <class Block>
AxisMatrix matrixOf(const Block& m) {
  return {{rowOf(m.col(0)), rowOf(m.col(1)), rowOf(m.col(2))}};
}
AxisPair pairOf(const Wrench& f) { return {rowOf(f.torque), rowOf(f.force)}; }
void setOffset(const FrameOffset& offset, LinkState& link) {
  link.offset = matrixOf(offset.rotation);
  link.offset_transposed = matrixOf(offset.rotation.transpose());
  link.translation = rowOf(offset.translation);
}

// Factors an inertia, of which Cholesky reads the lower half.
Cholesky<6> factorsOf(const InertiaBlocks& I) {
  Matrix6 K;
  for (int j = 0; j < 3; ++j) {
    K.block<3, 1>(0, j) = vectorOf(I.rotation.column[j]);
    K.block<1, 3>(3 + j, 0) = vectorOf(I.coupling.column[j]).transpose();
    K.block<3, 1>(3, 3 + j) = vectorOf(I.translation.column[j]);
  }
  return Cholesky<6>(K);
}

bool isSame(const TreePose& a, const TreePose& b) {
  return a.orientation.coeffs() == b.orientation.coeffs() && a.position == b.position &&
         a.joints == b.joints;
}

// Returns the wrench of Bullet's damping, which acts on the dry mass, in the link's frame.
Wrench dampingWrench(const LinkTree& tree, const Link& link, const Twist& V) {
  const double linear = tree.linear_damping * (1 + V.linear.norm());
  const double angular = tree.angular_damping * (1 + V.angular.norm());
  return {-angular * link.inertia.cwiseProduct(V.angular), -linear * link.mass * V.linear};
}

}  // namespace

InertiaBlocks blocksOf(const Matrix6& matrix) {
  return {matrixOf(matrix.topLeftCorner<3, 3>()), matrixOf(matrix.topRightCorner<3, 3>()),
          matrixOf(matrix.bottomRightCorner<3, 3>())};
}

Wrench product(const InertiaBlocks& I, const Twist& x) {
  const AxisRow(&J)[3] = I.rotation.column, (&C)[3] = I.coupling.column,
        (&M)[3] = I.translation.column;
  AxisRow torque{}, force{};
  for (int j = 0; j < 3; ++j) {
    torque.at += x.angular[j] * J[j].at + x.linear[j] * C[j].at;
    force.at += x.linear[j] * M[j].at;
  }
  const Vector3 v = x.angular;
  return {vectorOf(torque), vectorOf(force) + Vector3(vectorOf(C[0]).dot(v), vectorOf(C[1]).dot(v),
                                                      vectorOf(C[2]).dot(v))};
}

LinkDynamics::LinkDynamics(const LinkTree& tree) : tree_(tree), kernel_(*kLinkKernels.fastest()) {
  checkTree(tree);
  coordinates_ = coordinateCount(tree);
  missing_.resize(coordinates_);
  links_.resize(tree.size());
  pose_.joints.resize(tree.size());
  pose_.position.setConstant(std::numeric_limits<double>::quiet_NaN());  // that of no pose
  for (int l = 0, next = 0; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    LinkState& state = links_[l];
    state.parent = link.parent;
    state.first = next;
    state.axis_count = l == 0 ? 0 : axisCount(link.joint.kind);
    next += l == 0 ? 6 : state.axis_count;
    for (int i = 0; i < state.axis_count; ++i)
      state.axis[i] = pairOf(Wrench::fromVector(link.joint.axes[i]));
  }
}

void LinkDynamics::setForces(bool are_felt) noexcept {
  if (has_forces_ == are_felt) return;
  has_forces_ = are_felt;
  for (int l = 0; l < count(); ++l) setModel(tree_.links[l], links_[l]);
  kernel_.computePoses(links_.data(), count());
}

void LinkDynamics::setPose(const TreePose& pose) noexcept {
  for (int l = 0; l < count(); ++l) setModel(tree_.links[l], links_[l]);
  moveTo(pose);
}

void LinkDynamics::moveTo(const TreePose& pose) noexcept {
  AMBIENT_ASSERT(static_cast<int>(pose.joints.size()) == tree_.size());
  if (!isSame(pose, pose_)) setOffsets(pose);
  kernel_.computePoses(links_.data(), count());
}

void LinkDynamics::setOffsets(const TreePose& pose) noexcept {
  pose_ = pose;
  setOffset({pose.orientation.toRotationMatrix(), pose.position}, links_[0]);
  for (int l = 1; l < count(); ++l)
    setOffset(linkOffset(tree_.links[l].joint, pose.joints[l]), links_[l]);
}

void LinkDynamics::setModel(const Link& link, LinkState& state) noexcept {
  const Surroundings& s = link.surroundings;
  state.is_kept = link.keeps_velocity && (state.parent < 0 || links_[state.parent].is_kept);
  state.mass = link.mass;
  state.moments = rowOf(link.inertia);
  state.accelerates_flow = link.model && !s.ambient_acceleration.isZero(0);
  Wrench applied = has_forces_ ? s.applied : Wrench{};
  const Vector3 gravity = has_forces_ ? s.gravity : Vector3(Vector3::Zero());
  if (link.model) {
    const BodyModel& model = *link.model;
    state.inertia = blocksOf(model.inertia);
    state.coupling_transposed = matrixOf(model.inertia.bottomLeftCorner<3, 3>());
    applied.force -= model.mass * s.ambient_acceleration;
    state.buoyancy_W = rowOf(-model.displaced_mass * (gravity - s.ambient_acceleration));
    state.centre_of_volume = rowOf(model.centre_of_volume);
    state.flow_W = rowOf(s.ambient_velocity);
    state.flow_acceleration_W = rowOf(s.ambient_acceleration);
  } else {
    state.inertia = {matrixOf(Matrix3(link.inertia.asDiagonal())), AxisMatrix{},
                     matrixOf(Matrix3(link.mass * Matrix3::Identity()))};
    state.coupling_transposed = AxisMatrix{};
    state.buoyancy_W = state.centre_of_volume = state.flow_W = state.flow_acceleration_W =
        AxisRow{};
  }
  state.applied_W = pairOf(applied);
}

Matrix3 LinkDynamics::rotation(int link) const {
  const AxisMatrix& from = links_[link].rotation_W;
  Matrix3 R;
  for (int j = 0; j < 3; ++j) R.col(j) = vectorOf(from.column[j]);
  return R;
}

void LinkDynamics::setVelocity(const CoordinatesIn& u) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_);
  kernel_.setVelocity(links_.data(), count(), u.data());
}

void LinkDynamics::measure() noexcept { kernel_.measure(links_.data(), count()); }

Wrench LinkDynamics::appliedWrench(int link) const noexcept {
  const Matrix3 R = rotation(link);
  const Wrench damping = dampingWrench(tree_, tree_.links[link], twist(link));
  const Wrench& applied = tree_.links[link].surroundings.applied;
  return {applied.torque + R * damping.torque, applied.force + R * damping.force};
}

bool LinkDynamics::factor(const KickTerms* kick) noexcept {
  const bool is_positive = kernel_.articulate(links_.data(), count(), kick);
  if (links_[0].is_kept) return is_positive;
  base_ = factorsOf(links_[0].articulated);
  return is_positive && base_.isPositive();
}

double LinkDynamics::roughNormSquared(const CoordinatesIn& u) const noexcept {
  const auto trace = [](const AxisMatrix& m) {
    return m.column[0].at[0] + m.column[1].at[1] + m.column[2].at[2];
  };
  const LinkState& base = links_[0];
  double sum = 0;
  if (!base.is_kept) {
    sum = (trace(base.articulated.rotation) * u.head<3>().squaredNorm() +
           trace(base.articulated.translation) * u.segment<3>(3).squaredNorm()) /
          3;
  }
  for (const LinkState& link : links_) {
    if (link.is_kept) continue;
    for (int i = 0; i < link.axis_count; ++i)
      sum += link.weight[i] * u[link.first + i] * u[link.first + i];
  }
  return sum;
}

void LinkDynamics::accelerations(const CoordinatesIn& u, CoordinatesOut result) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_ && result.size() == coordinates_);
  kernel_.computeForces(links_.data(), count(), tree_, u.data(), nullptr);
  setJointForces();
  solve(result.data());
}

void LinkDynamics::correctAccelerations(const CoordinatesIn& u,
                                        CoordinatesOut accelerations) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_ && accelerations.size() == coordinates_);
  kernel_.computeForces(links_.data(), count(), tree_, u.data(), accelerations.data());
  setJointForces();
  solve(missing_.data());
  accelerations += missing_;
}

void LinkDynamics::setJointForces() noexcept {
  for (std::size_t l = 1; l < links_.size(); ++l)
    for (int i = 0; i < links_[l].axis_count; ++i)
      links_[l].rest[i] = has_forces_ ? tree_.links[l].joint_force[i] : 0;
}

void LinkDynamics::respond(const CoordinatesIn& force, CoordinatesOut response) noexcept {
  AMBIENT_ASSERT(force.size() == coordinates_ && response.size() == coordinates_);
  for (LinkState& link : links_) {
    link.force = AxisPair{};
    for (int i = 0; i < link.axis_count; ++i) link.rest[i] = force[link.first + i];
  }
  const Matrix3 to_base = rotation(0).transpose();
  links_[0].force = pairOf({to_base * -force.head<3>(), to_base * -force.segment<3>(3)});
  solve(response.data());
}

void LinkDynamics::respond(const std::vector<Wrench>& wrenches, CoordinatesOut response) noexcept {
  AMBIENT_ASSERT(wrenches.size() == links_.size());
  AMBIENT_ASSERT(response.size() == coordinates_);
  for (std::size_t l = 0; l < links_.size(); ++l) {
    links_[l].force = pairOf(-1.0 * wrenches[l]);
    for (double& rest : links_[l].rest) rest = 0;
  }
  solve(response.data());
}

void LinkDynamics::solve(double* result) noexcept {
  kernel_.sumNeeds(links_.data(), count());
  LinkState& base = links_[0];
  const Vector6 needed = -wrenchOf(base.force).vector();
  base.acceleration = base.is_kept ? AxisPair{} : pairOf(Wrench::fromVector(base_.solve(needed)));
  kernel_.accelerate(links_.data(), count(), result);
}

void LinkDynamics::inverseDynamics(const CoordinatesIn& u, const CoordinatesIn& acceleration,
                                   CoordinatesOut force) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_ && acceleration.size() == coordinates_);
  kernel_.computeForces(links_.data(), count(), tree_, u.data(), acceleration.data());
  kernel_.sumForces(links_.data(), count(), force.data());
}

void LinkDynamics::momentum(const CoordinatesIn& u, CoordinatesOut result) noexcept {
  AMBIENT_ASSERT(result.size() == coordinates_);
  setVelocity(u);
  kernel_.computeMomenta(links_.data(), count());
  kernel_.sumForces(links_.data(), count(), result.data());
}

double LinkDynamics::normSquared(const CoordinatesIn& u) noexcept {
  setVelocity(u);
  return kernel_.norm(links_.data(), count());
}

double LinkDynamics::kineticEnergy(const CoordinatesIn& u) noexcept {
  setVelocity(u);
  measure();
  double twice = 0;
  for (int l = 0; l < tree_.size(); ++l)
    twice += relativeEnergy(l) + tree_.links[l].mass * (twist(l).linear.squaredNorm() -
                                                        relativeTwist(l).linear.squaredNorm());
  return 0.5 * twice;
}

void LinkDynamics::appliedForces(CoordinatesOut result) noexcept {
  AMBIENT_ASSERT(result.size() == coordinates_);
  kernel_.computeApplied(links_.data(), count(), tree_);
  kernel_.sumForces(links_.data(), count(), result.data());
  if (!has_forces_) return;
  for (int l = 1; l < tree_.size(); ++l)
    for (int i = 0; i < links_[l].axis_count; ++i)
      result[links_[l].first + i] += tree_.links[l].joint_force[i];
}

void LinkDynamics::lockJoints() noexcept {
  kernel_.lockJoints(links_.data(), count());
  locked_ = factorsOf(links_[0].articulated);
}

Vector6 LinkDynamics::answerLocked(const Vector6& momentum) const noexcept {
  const Matrix3 R = rotation(0);
  const Vector6 result =
      locked_.solve(stack(R.transpose() * momentum.head<3>(), R.transpose() * momentum.tail<3>()));
  return stack(R * result.head<3>(), R * result.tail<3>());
}

Eigen::MatrixXd LinkDynamics::massMatrix() {
  Eigen::MatrixXd H(coordinates_, coordinates_);
  for (int i = 0; i < coordinates_; ++i) momentum(Eigen::VectorXd::Unit(coordinates_, i), H.col(i));
  for (const LinkState& link : links_) {
    if (!link.is_kept) continue;
    const int count = link.parent < 0 ? 6 : link.axis_count;
    H.middleRows(link.first, count).setZero();
    H.middleCols(link.first, count).setZero();
    H.block(link.first, link.first, count, count).setIdentity();
  }
  return H;
}

namespace {

constexpr double kLargestFactor = 1.5;  // largest factor on a velocity; its inverse is the smallest

bool isModest(double factor) { return factor < kLargestFactor && factor * kLargestFactor > 1; }

}  // namespace

LinkIntegrals::LinkIntegrals(const LinkTree& tree)
    : tree_(tree), flow_(coordinateCount(tree)), x_(flow_), momenta_(flow_) {}

void LinkIntegrals::store(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept {
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
  const Vector3 displacement = h / 2 * flow_.segment<3>(3), force = momenta_.segment<3>(3);
  momentum_.head<3>() +=
      h * (momenta_.head<3>() + (dynamics.position(0) - reference_ - displacement).cross(force));
  momentum_.tail<3>() += h * force;
  reference_ += 2 * displacement;
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
    dynamics.lockJoints();
    const Vector6 held = dynamics.answerLocked(its), base = dynamics.answerLocked(wanted);
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
  dynamics.lockJoints();
  u.head<6>() += dynamics.answerLocked(momentumAbout(dynamics.position(0)) - momenta_.head<6>());
}

}  // namespace ambient
