#pragma once

#include "bullet_ambient/motion/links/link_dynamics.h"

namespace ambient {

/// Keeps momentum and energy of a tree relative to its flow, docs/theory.md eq. (80a). Forces
/// change both in a substep by known amounts; the velocity at the end is corrected to have the
/// resulting values. They are not known, and nothing is corrected, if links are in different flows,
/// if a fixed base is in a flow that moves, or if velocities are prescribed. Only the constructor
/// allocates.
class LinkIntegrals {
 public:
  explicit LinkIntegrals(const LinkTree& tree);

  /// Stores momentum and energy of the velocity `u`. @pre `dynamics` has the pose
  void take(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept;
  /// Adds the changes of momentum and energy by the forces at the middle of a substep of h [s];
  /// `u`: middle velocity. @pre `dynamics` has this pose and velocity
  void addForces(LinkDynamics& dynamics, const CoordinatesIn& u, double h) noexcept;

  /// Corrects `u` to the stored momentum and energy, eq. (80a): a change of the base's velocity
  /// corrects the momentum, and a factor on the rest of the motion the energy. If that factor is
  /// not between 2/3 and 3/2, scales the whole motion to the stored energy instead, up by at most
  /// 3/2. If momentum and energy are not known and `is_coarse`, only scales down to the stored
  /// energy, and returns the energy removed [J]; otherwise returns 0. Keeps the factor of
  /// `dynamics` like holdJoints(). @pre `dynamics` has the pose
  double impose(LinkDynamics& dynamics, CoordinatesOut u, bool is_coarse) noexcept;
  /// Corrects `u` to the stored momentum by the base's velocity alone; joints keep their
  /// velocities. Keeps the factor of `dynamics` like holdJoints(). @pre `dynamics` has the pose
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
