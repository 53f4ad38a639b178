#include "bullet_ambient/motion/links/link_dynamics.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/kirchhoff.h"

namespace ambient {
namespace {

// Twist of the base in its frame from u, and back.
Twist baseTwist(const Matrix3& rotation_W, const double* u) {
  const Vector3 w(u[0], u[1], u[2]), v(u[3], u[4], u[5]);
  return {rotation_W.transpose() * w, rotation_W.transpose() * v};
}
void putInWorld(const Matrix3& rotation_W, const Vector3& a, const Vector3& b, double* u) {
  const Vector3 a_W = rotation_W * a, b_W = rotation_W * b;
  for (int i = 0; i < 3; ++i) {
    u[i] = a_W[i];
    u[3 + i] = b_W[i];
  }
}

// S q' of a joint.
Twist jointTwist(const LinkState& link, const double* velocity) {
  Twist x{Vector3::Zero(), Vector3::Zero()};
  for (int i = 0; i < link.axes; ++i) {
    x.angular += velocity[i] * link.axis[i].angular;
    x.linear += velocity[i] * link.axis[i].linear;
  }
  return x;
}

Twist plus(const Twist& a, const Twist& b) { return {a.angular + b.angular, a.linear + b.linear}; }

// V x S q', the acceleration of a link by the turn of its axes.
Twist crossTwist(const Twist& V, const Twist& s) {
  return {V.angular.cross(s.angular), V.linear.cross(s.angular) + V.angular.cross(s.linear)};
}

// Bullet's damping of the dry mass.
Wrench dampingWrench(const LinkTree& tree, const Link& link, const Twist& V) {
  const double linear = tree.linear_damping * (1 + V.linear.norm());
  const double angular = tree.angular_damping * (1 + V.angular.norm());
  return {-angular * link.inertia.cwiseProduct(V.angular), -linear * link.mass * V.linear};
}

}  // namespace

LinkDynamics::LinkDynamics(const LinkTree& tree) : tree_(tree) {
  checkTree(tree);
  coordinates_ = coordinateCount(tree);
  missing_.resize(coordinates_);
  const std::vector<int> first = firstCoordinates(tree);
  links_.resize(tree.size());
  for (int l = 0; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    LinkState& state = links_[l];
    state.parent = link.parent;
    state.first = first[l];
    state.axes = l == 0 ? 0 : axisCount(link.joint.kind);
    for (int i = 0; i < state.axes; ++i) state.axis[i] = Twist::fromVector(link.joint.axes[i]);
  }
}

void LinkDynamics::setPose(const TreePose& pose) noexcept {
  AMBIENT_ASSERT(static_cast<int>(pose.joints.size()) == tree_.size());
  for (int l = 0; l < tree_.size(); ++l) {
    const Link& link = tree_.links[l];
    LinkState& state = links_[l];
    if (l == 0) {
      state.offset = {pose.orientation.toRotationMatrix(), pose.position};
      state.rotation_W = state.offset.rotation;
      state.position_W = pose.position;
      state.is_kept = link.keeps_velocity;
    } else {
      const LinkState& parent = links_[state.parent];
      state.offset = linkOffset(link.joint, pose.joints[l]);
      state.rotation_W = parent.rotation_W * state.offset.rotation;
      state.position_W = parent.position_W + parent.rotation_W * state.offset.translation;
      state.is_kept = link.keeps_velocity && parent.is_kept;
    }
    takeModel(link, state);
  }
}

void LinkDynamics::takeModel(const Link& link, LinkState& state) noexcept {
  if (link.model) {
    state.inertia = LinkInertia::fromMatrix(link.model->inertia);
    state.flow = state.rotation_W.transpose() * link.surroundings.ambient_velocity;
  } else {
    state.inertia = LinkInertia::ofBody(link.mass, link.inertia);
    state.flow.setZero();
  }
}

void LinkDynamics::setVelocity(const CoordinatesIn& u) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_);
  for (LinkState& link : links_) {
    link.twist = link.parent < 0 ? baseTwist(link.rotation_W, u.data())
                                 : plus(link.offset.toF(links_[link.parent].twist),
                                        jointTwist(link, u.data() + link.first));
  }
}

// V, A and f of eq. (76), (77) with the given du/dt, null for none.
void LinkDynamics::computeForces(const double* u, const double* acceleration) noexcept {
  for (int l = 0; l < tree_.size(); ++l) {
    LinkState& link = links_[l];
    if (l == 0) {
      link.twist = baseTwist(link.rotation_W, u);
      link.acceleration = {Vector3::Zero(), Vector3::Zero()};
      if (!link.is_kept) link.acceleration.linear = link.twist.linear.cross(link.twist.angular);
      if (acceleration)
        link.acceleration = plus(link.acceleration, baseTwist(link.rotation_W, acceleration));
    } else {
      const LinkState& parent = links_[link.parent];
      const Twist relative = jointTwist(link, u + link.first);
      link.twist = plus(link.offset.toF(parent.twist), relative);
      link.acceleration =
          plus(link.offset.toF(parent.acceleration), crossTwist(link.twist, relative));
      if (acceleration)
        link.acceleration = plus(link.acceleration, jointTwist(link, acceleration + link.first));
    }
    link.force = forceOn(tree_.links[l], link);
  }
}

// f of one link: what accelerates it, less what acts on it.
Wrench LinkDynamics::forceOn(const Link& link, const LinkState& state) const noexcept {
  const Twist V_r{state.twist.angular, state.twist.linear - state.flow};
  const Twist A_r{state.acceleration.angular,
                  state.acceleration.linear + state.twist.angular.cross(state.flow)};
  Wrench f = state.inertia.wrench(A_r);
  f -= gyroscopicWrench(state.inertia.momentum(V_r), V_r);
  f -= appliedOn(link, state);
  return f;
}

// Returns the wrench of the surroundings and of Bullet's own forces on a link, in its frame.
Wrench LinkDynamics::appliedOn(const Link& link, const LinkState& state) const noexcept {
  const Surroundings& s = link.surroundings;
  const auto to_link = state.rotation_W.transpose();
  Wrench f = link.model ? externalWrench(*link.model, s, state.rotation_W)
                        : Wrench{to_link * s.applied.torque, to_link * s.applied.force};
  if (link.model && s.ambient_acceleration != Vector3::Zero())
    f += state.inertia.wrench({Vector3::Zero(), to_link * s.ambient_acceleration});
  if (tree_.linear_damping != 0 || tree_.angular_damping != 0)
    f += dampingWrench(tree_, link, state.twist);
  if (!tree_.has_gyroscopic_term) {
    const Vector3& w = state.twist.angular;
    f.torque += w.cross(link.inertia.cwiseProduct(w));
  }
  return f;
}

Wrench LinkDynamics::appliedWrench(int link) const noexcept {
  const LinkState& state = links_[link];
  const Wrench damping = dampingWrench(tree_, tree_.links[link], state.twist);
  const Wrench& applied = tree_.links[link].surroundings.applied;
  return {applied.torque + state.rotation_W * damping.torque,
          applied.force + state.rotation_W * damping.force};
}

void LinkDynamics::inverseDynamics(const CoordinatesIn& u, const CoordinatesIn& acceleration,
                                   CoordinatesOut force) noexcept {
  AMBIENT_ASSERT(u.size() == coordinates_ && acceleration.size() == coordinates_);
  computeForces(u.data(), acceleration.data());
  sumForces(force.data());
}

// Subtree sums of the links' forces, and what they are along the coordinates.
void LinkDynamics::sumForces(double* force) noexcept {
  for (int l = tree_.size() - 1; l > 0; --l) {
    const LinkState& link = links_[l];
    for (int i = 0; i < link.axes; ++i) force[link.first + i] = power(link.force, link.axis[i]);
    links_[link.parent].force += link.offset.toB(link.force);
  }
  const LinkState& base = links_[0];
  putInWorld(base.rotation_W, base.force.torque, base.force.force, force);
}

void LinkDynamics::momentum(const CoordinatesIn& u, CoordinatesOut result) noexcept {
  AMBIENT_ASSERT(result.size() == coordinates_);
  setVelocity(u);
  for (LinkState& link : links_) {
    link.force = link.inertia.wrench(link.twist);
  }
  sumForces(result.data());
}

double LinkDynamics::normSquared(const CoordinatesIn& u) noexcept {
  setVelocity(u);
  double sum = 0;
  for (const LinkState& link : links_) sum += power(link.inertia.wrench(link.twist), link.twist);
  return sum;
}

double LinkDynamics::kineticEnergy(const CoordinatesIn& u) noexcept {
  setVelocity(u);
  double twice = 0;
  for (int l = 0; l < tree_.size(); ++l) {
    const Twist V_r = relativeTwist(l);
    const Vector3& v = links_[l].twist.linear;
    twice += power(links_[l].inertia.wrench(V_r), V_r) +
             tree_.links[l].mass * (v.squaredNorm() - V_r.linear.squaredNorm());
  }
  return 0.5 * twice;
}

void LinkDynamics::appliedForces(CoordinatesOut result) noexcept {
  AMBIENT_ASSERT(result.size() == coordinates_);
  for (int l = 0; l < tree_.size(); ++l) links_[l].force = appliedOn(tree_.links[l], links_[l]);
  sumForces(result.data());
  for (int l = 1; l < tree_.size(); ++l)
    for (int i = 0; i < links_[l].axes; ++i)
      result[links_[l].first + i] += tree_.links[l].joint_force[i];
}

Eigen::MatrixXd LinkDynamics::massMatrix() {
  Eigen::MatrixXd H(coordinates_, coordinates_);
  for (int i = 0; i < coordinates_; ++i) momentum(Eigen::VectorXd::Unit(coordinates_, i), H.col(i));
  for (const LinkState& link : links_) {
    if (!link.is_kept) continue;
    const int count = link.parent < 0 ? 6 : link.axes;
    H.middleRows(link.first, count).setZero();
    H.middleCols(link.first, count).setZero();
    H.block(link.first, link.first, count, count).setIdentity();
  }
  return H;
}

}  // namespace ambient
