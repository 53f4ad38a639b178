#pragma once

#include "bullet_ambient/motion/links/link_dynamics.h"

namespace ambient {

/// Momentum and energy of a tree relative to its flow, docs/theory.md eq. (80a): what forces change
/// of them in a substep is known, and the velocity at its end is made to have it. Not where links
/// are in different flows, or held in one that moves, or driven: flow and links then exchange more.
/// All but the constructor is free of allocation.
class LinkIntegrals {
 public:
  explicit LinkIntegrals(const LinkTree& tree);

  /// Takes both. @pre `dynamics` has the pose
  void take(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept;
  /// Adds what the forces at the middle of a substep change. @pre `dynamics` has pose and velocity
  void addForces(LinkDynamics& dynamics, const CoordinatesIn& u, double h) noexcept;

  /// Gives `u` both: the tree with its joints held the momentum, what is left the energy. Where
  /// that would change the motion of the joints by more than half, the energy alone, and at most
  /// half more than it has. Where they are not known and the substep is coarse, at most that
  /// energy. Returns what this bound has removed [J].
  /// @pre `dynamics` has the pose. Its factor is lost.
  double impose(LinkDynamics& dynamics, CoordinatesOut u, bool is_coarse) noexcept;
  /// The momentum alone, by the base: joints keep their velocities. As impose() in all else.
  void imposeMomentum(LinkDynamics& dynamics, CoordinatesOut u) noexcept;

 private:
  Vector6 momentumAbout(const Vector3& point_W) const noexcept;

  const LinkTree& tree_;
  bool is_known_ = false;
  bool floats_ = false;
  Vector6 momentum_;   // about reference_, in W
  double energy_ = 0;  // twice
  Vector3 reference_;  // point of W that goes with the flow [m]
  Coordinates flow_, x_, momenta_;
};

}  // namespace ambient
