#pragma once

#include "bullet_ambient/motion/links/link_integrals.h"
#include "bullet_ambient/motion/links/link_kick.h"

namespace ambient {

struct LinkFlightSettings {
  double tolerance = 1e-3;  ///< of the velocity per substep, relative to the motion, eq. (25)
  int max_iterations = 2;   ///< of the implicit midpoint, per substep
  int max_substeps = 16;
};

/// Result of a step for a tree.
struct LinkFlightResult {
  FlightCount count;
  bool is_finite = false;  ///< if not, nothing of it is to be used
};

/// Velocities of one tree over a step, docs/theory.md eq. (80). Has the memory that this needs;
/// all but the constructor is free of allocation.
class LinkFlight {
 public:
  explicit LinkFlight(const LinkTree& tree);

  LinkDynamics& dynamics() { return dynamics_; }
  const LinkDynamics& dynamics() const { return dynamics_; }

  /// Flight without rows, or with those of joints alone: implicit midpoint between half kicks by
  /// the loads, in substeps where links turn fast.
  LinkFlightResult fly(const TreePose& start, const CoordinatesIn& u, double duration,
                       const LinkFlightSettings& settings) noexcept;
  /// Takes the place of a flight that is not to move the tree: endPose() is `pose`, all velocities
  /// are `u`.
  void stay(const TreePose& pose, const CoordinatesIn& u) noexcept;
  /// The constant velocity by which Bullet comes to endPose().
  const Coordinates& meanVelocity() const { return mean_; }
  const Coordinates& endVelocity() const { return end_; }
  const TreePose& endPose() const { return end_pose_; }
  /// Sets dynamics() to the middle of the last substep of fly() and factors it: rows of joints are
  /// to be answered by it.
  void prepareJointRows() noexcept;
  /// For a tree that reached another pose than endPose(): gives its velocity there the momentum
  /// and energy of the flight. Rows of joints change the energy; with them only the momentum, by
  /// the base. Returns the energy that the bound of LinkIntegrals::impose() has removed [J].
  double arriveAt(const TreePose& reached, bool has_rows, Coordinates& velocity) noexcept;

  /// Velocity that rows of contacts are solved against: explicit, at the start pose. dynamics() is
  /// left there, factored.
  LinkFlightResult computeRowVelocity(const TreePose& start, const CoordinatesIn& u,
                                      double duration) noexcept;
  const Coordinates& rowVelocity() const { return end_; }
  /// Change of velocity in the step by the turn of the links: h times du/dt less that of a tree at
  /// rest in its flow. No part of rowVelocity(): that of a fast turn is no velocity at all.
  const Coordinates& turning() const { return mean_; }

 private:
  int flyInSubsteps(int substeps, double duration, const LinkFlightSettings& settings,
                    FlightCount& count) noexcept;
  double largestSpin() const noexcept;
  bool findMiddle(double h, const LinkFlightSettings& settings) noexcept;
  double kickAtEnd(double h, FlightCount& count) noexcept;

  const LinkTree& tree_;
  LinkDynamics dynamics_;
  LinkKick kick_;
  LinkIntegrals integrals_;
  Coordinates mean_, end_, start_, rate_;
  TreePose end_pose_, middle_;
  bool answers_rows_ = false;  // dynamics_ is in the middle, factored
};

}  // namespace ambient
