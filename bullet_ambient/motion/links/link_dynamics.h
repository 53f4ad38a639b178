#pragma once

#include <vector>

#include "bullet_ambient/motion/links/link_tree.h"
#include "bullet_ambient/spatial/cholesky.h"

namespace ambient {

inline Vector3 vectorOf(const AxisRow& a) { return {a.at[0], a.at[1], a.at[2]}; }
inline Wrench wrenchOf(const AxisPair& f) { return {vectorOf(f.angular), vectorOf(f.linear)}; }

/// Blocks of a symmetric matrix, and its product with a twist.
InertiaBlocks blocksOf(const Matrix6& matrix);
Wrench product(const InertiaBlocks& matrix, const Twist& x);

/// Equations of motion of a tree at one pose, docs/theory.md eq. (76) to (79):
///
///   H(q) du/dt = rhs(q, u),   H = sum over links J_l^T K_l J_l,   V_l = J_l u
///
///   K_l   total inertia of a link: body and fluid
///   V_l   twist of a link in its frame;  V_rl  the same relative to the ambient flow
///   J_l   Jacobian of the link, 6 x coordinates()
///
/// H is not formed. It is factored by articulated inertias, in time and memory proportional to the
/// number of links. Kernels give the same bits with every instruction set. Only the constructor and
/// massMatrix() allocate. If an input is not finite, results are not finite: check them before use.
/// Prescribed velocities (Link::keeps_velocity) have zero in accelerations and responses.
class LinkDynamics {
 public:
  /// `tree` must outlive the object. Its models and members that are set in each step may change;
  /// links and joints must not.
  explicit LinkDynamics(const LinkTree& tree);

  const LinkTree& tree() const { return tree_; }
  int coordinates() const { return coordinates_; }
  /// Returns the index in u of the first velocity of the link's joint: 6 +
  /// btMultibodyLink::m_dofOffset; 0 for the base.
  int firstCoordinate(int link) const { return links_[link].first; }

  /// Sets the pose, and reads models, flows and forces from the tree, for all later calls. Cost:
  /// O(links).
  void setPose(const TreePose& pose) noexcept;
  /// Leaves gravity, applied forces and joint forces out of all later calls, or takes them in
  /// again.
  /// @pre setPose()
  void setForces(bool are_felt) noexcept;
  /// Sets another pose, with the models, flows and forces of the last setPose().
  void moveTo(const TreePose& pose) noexcept;

  /// Rotation from a link's frame to W, and its centre of mass in W [m].
  Matrix3 rotation(int link) const;
  Vector3 position(int link) const { return vectorOf(links_[link].position_W); }

  /// Factors H by articulated inertias, eq. (79), for accelerations and responses. Returns false if
  /// H is not positive definite or not finite. Cost: O(links). With the terms of a kick factors
  /// M = sum J_l^T ((1 + drag_l) K_l + h C_l) J_l of eq. (81) and (123) in place of H.
  bool factor(const KickTerms* kick = nullptr) noexcept;

  /// Returns an estimate of normSquared() from diagonals of the factor, within its order of
  /// magnitude, at almost no cost [J]. @pre factor()
  double roughNormSquared(const CoordinatesIn& u) const noexcept;

  /// Computes du/dt by applied forces, buoyancy and joint forces, without surface loads. @pre
  /// factor()
  void accelerations(const CoordinatesIn& u, CoordinatesOut result) noexcept;

  /// Improves approximate accelerations a by a + H^-1 (rhs - H a), docs/theory.md eq. (80). H^-1 is
  /// that of the last factor(), which may be at another pose nearby; rhs and H a are at the present
  /// pose.
  void correctAccelerations(const CoordinatesIn& u, CoordinatesOut accelerations) noexcept;

  /// Computes H^-1 f for a generalized force or impulse f, such as the row J^T of a constraint.
  /// @pre factor()
  void respond(const CoordinatesIn& force, CoordinatesOut response) noexcept;
  /// Computes H^-1 sum J_l^T F_l for a wrench F_l on each link, in the link's frame. @pre factor()
  void respond(const std::vector<Wrench>& wrenches, CoordinatesOut response) noexcept;

  /// Computes the generalized forces H du/dt - rhs that cause `acceleration`, with zero for
  /// Link::joint_force. Entries of prescribed velocities are the forces that keep these.
  void inverseDynamics(const CoordinatesIn& u, const CoordinatesIn& acceleration,
                       CoordinatesOut force) noexcept;
  /// Returns the wrench that the joint of `link` transmits from its parent, about the link's centre
  /// of mass, in its axes. Contains surface loads and wrenches of constraints only if
  /// surroundings.applied does. @pre inverseDynamics()
  Wrench jointWrench(int link) const { return wrenchOf(links_[link].force); }

  /// Computes V_l of all links. accelerations() and inverseDynamics() do this, too.
  void setVelocity(const CoordinatesIn& u) noexcept;
  Twist twist(int link) const {
    const AxisPair& x = links_[link].twist;
    return {vectorOf(x.angular), vectorOf(x.linear)};
  }
  /// Returns V_rl, the twist relative to the ambient flow.
  Twist relativeTwist(int link) const {
    const Twist x = twist(link);
    return {x.angular, x.linear - vectorOf(links_[link].flow)};
  }
  /// Computes momentum and energy of all links relative to their flows. @pre setVelocity()
  void measure() noexcept;
  /// Returns K_l V_rl in the link's frame. @pre measure()
  Wrench relativeMomentum(int link) const { return wrenchOf(links_[link].force); }
  /// Returns V_rl.K_l V_rl, twice the kinetic energy [J]. @pre measure()
  double relativeEnergy(int link) const { return links_[link].energy; }

  /// Returns the wrench of applied forces and of Bullet's damping on a link, without buoyancy, in W
  /// about its centre of mass. @pre setPose(), setVelocity()
  Wrench appliedWrench(int link) const noexcept;

  /// Computes H u, without the flow; prescribed velocities contribute.
  void momentum(const CoordinatesIn& u, CoordinatesOut result) noexcept;
  /// Returns u.H u, twice the kinetic energy of links and fluid at rest [J]; prescribed velocities
  /// contribute.
  double normSquared(const CoordinatesIn& u) noexcept;
  /// Returns the kinetic energy of links, V_l.K_b V_l / 2, and of the fluid relative to its flow,
  /// V_rl.K_f V_rl / 2 [J].
  double kineticEnergy(const CoordinatesIn& u) noexcept;

  /// Computes the generalized forces of applied forces, buoyancy, damping and joints, in a frame
  /// that moves with the present velocity of the flow and does not accelerate with it. @pre
  /// setPose(), setVelocity()
  void appliedForces(CoordinatesOut result) noexcept;

  /// Factors I_c of eq. (80a), the inertia of the tree with its joints held. Keeps the factor of H,
  /// but not the diagonals that roughNormSquared() reads.
  void lockJoints() noexcept;
  /// Returns I_c^-1 momentum: velocity of the base of a tree with held joints that has this
  /// momentum. Both about the base's centre of mass, in W, rotation first. @pre lockJoints(); the
  /// base's velocity is not prescribed
  Vector6 answerLocked(const Vector6& momentum) const noexcept;

  /// Returns H, symmetric, coordinates() x coordinates(), with rows and columns of the identity for
  /// prescribed velocities. For programs and tests. Cost: O(links^2), allocates.
  Eigen::MatrixXd massMatrix();

 private:
  int count() const { return static_cast<int>(links_.size()); }
  void setModel(const Link& link, LinkState& state) noexcept;
  void setOffsets(const TreePose& pose) noexcept;
  void setJointForces() noexcept;
  void solve(double* result) noexcept;

  const LinkTree& tree_;
  int coordinates_ = 0;
  bool has_forces_ = true;
  std::vector<LinkState> links_;
  TreePose pose_;  // of the offsets in links_
  const LinkKernel& kernel_;
  Cholesky<6> base_;     // of the base's articulated inertia
  Cholesky<6> locked_;   // of I_c, from lockJoints()
  Coordinates missing_;  // scratch memory of correctAccelerations()
};

/// Keeps momentum and energy of a tree relative to its flow, docs/theory.md eq. (80a). Forces
/// change both in a substep by known amounts; the velocity at the end is corrected to have the
/// resulting values. They are not known, and nothing is corrected, if links are in different flows,
/// if a fixed base is in a flow that moves, or if velocities are prescribed. Only the constructor
/// allocates.
class LinkIntegrals {
 public:
  explicit LinkIntegrals(const LinkTree& tree);

  /// Stores momentum and energy of the velocity `u`. @pre `dynamics` has the pose
  void store(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept;
  /// Adds the changes of momentum and energy by the forces at the middle of a substep of h [s];
  /// `u`: middle velocity. @pre `dynamics` has this pose and velocity
  void addForces(LinkDynamics& dynamics, const CoordinatesIn& u, double h) noexcept;

  /// Corrects `u` to the stored momentum and energy, eq. (80a): a change of the base's velocity
  /// corrects the momentum, and a factor on the rest of the motion the energy. If that factor is
  /// not between 2/3 and 3/2, scales the whole motion to the stored energy instead, up by at most
  /// 3/2. If momentum and energy are not known and `is_coarse`, only scales down to the stored
  /// energy, and returns the energy removed [J]; otherwise returns 0. Keeps the factor of
  /// `dynamics` like lockJoints(). @pre `dynamics` has the pose
  double impose(LinkDynamics& dynamics, CoordinatesOut u, bool is_coarse) noexcept;
  /// Corrects `u` to the stored momentum by the base's velocity alone; joints keep their
  /// velocities. Keeps the factor of `dynamics` like lockJoints(). @pre `dynamics` has the pose
  void imposeMomentum(LinkDynamics& dynamics, CoordinatesOut u) noexcept;

 private:
  Vector6 momentumAbout(const Vector3& point_W) const noexcept;

  const LinkTree& tree_;
  bool is_known_ = false;
  bool floats_ = false;
  Vector6 momentum_;   // relative to the flow, about reference_, in W
  double energy_ = 0;  // twice the kinetic energy [J]
  Vector3 reference_;  // point in W that moves with the flow [m]
  Coordinates flow_, x_, momenta_;
};

}  // namespace ambient
