#pragma once

#include "bullet_ambient/motion/links/link_dynamics.h"
#include "bullet_ambient/motion/links/link_kick.h"

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

struct LinkFlightSettings {
  double tolerance = 1e-3;  ///< largest error of the velocity per substep, docs/theory.md eq. (25)
  int max_iterations = 2;   ///< rounds of eq. (80) for the middle velocity, per substep
  int max_substeps = 16;
};

/// Result of a step for a tree.
struct LinkFlightResult {
  FlightCount count;
  bool is_finite = false;  ///< false: velocities and poses must not be used
};

/// Computes the motion of one tree over a step, docs/theory.md eq. (80). Only the constructor
/// allocates.
class LinkFlight {
 public:
  explicit LinkFlight(const LinkTree& tree);

  LinkDynamics& dynamics() { return dynamics_; }
  const LinkDynamics& dynamics() const { return dynamics_; }

  /// Flies a tree from pose `start` with velocity `u` over `duration` [s]: implicit midpoint
  /// between half kicks by the surface loads, eq. (80), (81), in substeps if links turn fast or
  /// loads change much. Begins with the loads of Link::memory, and leaves those of the end there.
  /// Results: endPose(), endVelocity(), meanVelocity().
  LinkFlightResult fly(const TreePose& start, const CoordinatesIn& u, double duration,
                       const LinkFlightSettings& settings) noexcept;
  /// Sets the results of a flight that ends at `pose`, with end and mean velocity `u`.
  void stay(const TreePose& pose, const CoordinatesIn& u) noexcept;
  /// Returns the constant velocity by which Bullet moves the tree to endPose().
  const Coordinates& meanVelocity() const { return mean_; }
  const Coordinates& endVelocity() const { return end_; }
  const TreePose& endPose() const { return end_pose_; }
  /// Sets dynamics() to the pose in the middle of the last substep of fly(), and factors H there,
  /// for the response of rows of joints.
  void prepareJointRows() noexcept;
  /// Corrects the velocity of a tree that Bullet has moved to another pose than endPose(), so that
  /// it has the momentum and the energy of the flight, eq. (80a). With `has_rows`, corrects the
  /// momentum alone, by the base's velocity, because rows of joints change the energy. Returns the
  /// energy that LinkIntegrals::impose() has removed [J].
  double arriveAt(const TreePose& reached, bool has_rows, Coordinates& velocity) noexcept;

  /// Computes the velocity x that rows of contacts are solved against, explicitly at the start
  /// pose, and the turning part t: rowVelocity(), turning(). Leaves dynamics() at `start`, with H
  /// factored, or in a fluid that settles the tree with the matrix of its kick.
  LinkFlightResult computeRowVelocity(const TreePose& start, const CoordinatesIn& u,
                                      double duration) noexcept;
  const Coordinates& rowVelocity() const { return end_; }
  /// Returns the part of rowVelocity() by surface loads.
  const Coordinates& rowVelocityByLoads() const { return correction_; }
  /// Returns the turning part t of eq. (28): h times the difference of du/dt at u and at rest in
  /// the flow. Not contained in rowVelocity(), because it is meaningless in a fast turn.
  const Coordinates& turning() const { return mean_; }

 private:
  int flyInSubsteps(int substeps, double duration, const LinkFlightSettings& settings,
                    FlightCount& count) noexcept;
  double largestSpin() const noexcept;
  bool findMiddle(double h, const LinkFlightSettings& settings) noexcept;
  double kickAtEnd(double h, FlightCount& count) noexcept;
  void kickBy(double h, Coordinates& u) noexcept;

  const LinkTree& tree_;
  LinkDynamics dynamics_;
  LinkKick kick_;
  LinkIntegrals integrals_;
  Coordinates mean_, end_, start_, rate_, correction_, forces_;
  TreePose end_pose_, middle_;
  bool is_stiff_ = false;      ///< forces are in the kicks
  bool answers_rows_ = false;  // true: prepareJointRows() was called since the flight
};

}  // namespace ambient
