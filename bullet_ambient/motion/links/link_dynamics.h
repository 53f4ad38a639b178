#pragma once

#include <vector>

#include "bullet_ambient/motion/links/link_kernel.h"
#include "bullet_ambient/motion/links/link_tree.h"

namespace ambient {

/// Equations of motion of a tree at one pose, docs/theory.md eq. (76) to (79):
///
///   H(q) du/dt = rhs(q, u),   H = sum over links J_l^T K_l J_l,   V_l = J_l u
///
///   K_l  total inertia of a link, of body and fluid
///   V_l  twist of a link in its frame, V_rl relative to its ambient flow
///
/// H is not formed: it is factored by articulated inertias, in time and memory proportional to the
/// links, by kernels with the same bits on every instruction set. All but the constructor is free
/// of allocation. A result is not finite where an input is not: check before use. Velocities that
/// are kept (Link::keeps_velocity) have zero in accelerations and responses.
class LinkDynamics {
 public:
  /// `tree` has to live as long. Its models and what is set in each step may change; links and
  /// joints may not.
  explicit LinkDynamics(const LinkTree& tree);

  const LinkTree& tree() const { return tree_; }
  int coordinates() const { return coordinates_; }
  /// First coordinate of the link's joint in u: 6 + btMultibodyLink::m_dofOffset; 0 for the base.
  int firstCoordinate(int link) const { return links_[link].first; }

  /// Takes pose, models, flows and forces; all that follows is for these. Cost: O(links).
  void setPose(const TreePose& pose) noexcept;
  /// Takes another pose, with the models, flows and forces of the last setPose().
  void moveTo(const TreePose& pose) noexcept;

  /// Axes of a link, its frame to W, and its centre of mass in W [m].
  Matrix3 rotation(int link) const;
  Vector3 position(int link) const { return vectorOf(links_[link].position_W); }

  /// Makes the articulated inertias that accelerations and responses need. False if H is not
  /// positive definite, or not finite. Cost: O(links).
  bool factor() noexcept;
  /// Factors sum (1 + drag_l) J_l^T K_l J_l in place of H, with a drag >= 0 for each link.
  bool factor(const std::vector<double>& drag) noexcept;

  /// Size of velocities by the diagonal of the factored H: of the order of normSquared(), at almost
  /// no cost. @pre factor()
  double roughNormSquared(const CoordinatesIn& u) const noexcept;

  /// du/dt under forces, buoyancy and joint forces; without surface loads. @pre factor()
  void accelerations(const CoordinatesIn& u, CoordinatesOut result) noexcept;

  /// Adds to approximate accelerations what they lack by the inverse dynamics, answered by the
  /// factored H of a pose nearby: setPose() may have come after factor().
  void correctAccelerations(const CoordinatesIn& u, CoordinatesOut accelerations) noexcept;

  /// H^-1 f of a generalized force or impulse, such as the row J^T of a constraint. @pre factor()
  void respond(const CoordinatesIn& force, CoordinatesOut response) noexcept;
  /// H^-1 sum J_l^T F_l of a wrench on each link, in the link's frame. @pre factor()
  void respond(const std::vector<Wrench>& wrenches, CoordinatesOut response) noexcept;

  /// Generalized forces that accelerate by `acceleration`: H du/dt - rhs, with joint_force taken as
  /// zero. Forces on kept velocities are those that keep them.
  void inverseDynamics(const CoordinatesIn& u, const CoordinatesIn& acceleration,
                       CoordinatesOut force) noexcept;
  /// After inverseDynamics(): what the joint of `link` transmits from its parent, about the link's
  /// centre of mass in its axes. Surface loads and wrenches of constraints count if they are in
  /// surroundings.applied.
  Wrench jointWrench(int link) const { return wrenchOf(links_[link].force); }

  /// V_l of all links. accelerations() and inverseDynamics() do so too.
  void setVelocity(const CoordinatesIn& u) noexcept;
  Twist twist(int link) const {
    const AxisPair& x = links_[link].twist;
    return {vectorOf(x.angular), vectorOf(x.linear)};
  }
  /// Relative to the ambient flow.
  Twist relativeTwist(int link) const {
    const Twist x = twist(link);
    return {x.angular, x.linear - vectorOf(links_[link].flow)};
  }
  /// Sets momentum and energy of the motion of all links relative to their flows. @pre
  /// setVelocity()
  void measure() noexcept;
  /// K V_rl. @pre measure()
  Wrench relativeMomentum(int link) const { return wrenchOf(links_[link].force); }
  /// V_rl.K V_rl: twice the energy [J]. @pre measure()
  double relativeEnergy(int link) const { return links_[link].energy; }

  /// Forces of surroundings and of Bullet's damping on a link, without buoyancy, in W about its
  /// centre of mass. @pre setPose(), setVelocity()
  Wrench appliedWrench(int link) const noexcept;

  /// H u, whatever the flow; with what kept velocities have in it.
  void momentum(const CoordinatesIn& u, CoordinatesOut result) noexcept;
  /// u.H u, kept velocities included: twice the kinetic energy of links and fluid, if the fluid is
  /// at rest [J].
  double normSquared(const CoordinatesIn& u) noexcept;
  /// Kinetic energy of links, V_l.K_b V_l / 2, and of fluid relative to its flow, V_rl.K_f V_rl / 2
  /// [J].
  double kineticEnergy(const CoordinatesIn& u) noexcept;

  /// Generalized forces of surroundings, damping and joints on a tree, as they are in a frame that
  /// does not accelerate with the flow. @pre setPose(), setVelocity()
  void appliedForces(CoordinatesOut result) noexcept;

  /// Factors the inertia of a tree with all its joints held. The factor of H stays.
  void holdJoints() noexcept;
  /// Velocity that a momentum gives to the base of such a tree: both about its centre of mass, in
  /// W, rotation first. @pre holdJoints(), a base that does not keep its velocity
  Vector6 answerHeld(const Vector6& momentum) const noexcept;

  /// H, symmetric, coordinates() x coordinates(), with rows and columns of the identity for kept
  /// velocities; for programs and tests. Cost: O(links^2), allocates.
  Eigen::MatrixXd massMatrix();

 private:
  static Vector3 vectorOf(const AxisRow& a) { return {a.at[0], a.at[1], a.at[2]}; }
  static Wrench wrenchOf(const AxisPair& f) { return {vectorOf(f.angular), vectorOf(f.linear)}; }

  int count() const { return static_cast<int>(links_.size()); }
  TreeHabits habits() const;
  void takeModel(const Link& link, LinkState& state) noexcept;
  void takeJointForces() noexcept;
  void solve(double* result) noexcept;

  const LinkTree& tree_;
  int coordinates_ = 0;
  std::vector<LinkState> links_;
  std::vector<Matrix3> zero_axes_;  // of links in their parents' axes, at position zero
  const LinkKernel& kernel_;
  BaseFactor base_;      // of its articulated inertia
  BaseFactor held_;      // of holdJoints()
  Coordinates missing_;  // of correctAccelerations()
};

}  // namespace ambient
