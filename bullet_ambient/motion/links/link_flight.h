#pragma once

#include <vector>

#include "bullet_ambient/motion/links/link_dynamics.h"

namespace ambient {

/// Kicks a tree by the surface loads on its links, docs/theory.md eq. (81) and (123): drag
/// implicit, link by link, and so is resistance; lift explicit, without work. Only the constructor
/// allocates.
class LinkKick {
 public:
  explicit LinkKick(const LinkTree& tree);

  /// True if any link has surface loads.
  bool hasLoads() const noexcept;

  /// Evaluates and stores the loads at the velocity `u` and the pose of `dynamics`, with the
  /// passivity guard.
  FlightCount sample(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept;
  /// Does so for rows, which see one kick of a time h [s]: loads of fluid that turns with a link
  /// are the mean of that kick, docs/theory.md eq. (87).
  FlightCount sampleForRows(LinkDynamics& dynamics, const CoordinatesIn& u, double h) noexcept;
  /// Stores the loads that links remember as those at the velocity `u` and the pose of `dynamics`,
  /// and evaluates the others.
  FlightCount recall(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept;
  /// Makes links remember the last sample. @pre `dynamics` has its pose
  void remember(const LinkDynamics& dynamics) const noexcept;
  /// Returns the error of docs/theory.md eq. (25): size of the velocity change in the time h [s] by
  /// the difference between the last sample and its prediction by the sample before, over that of
  /// the motion. @pre kick() was called after that sample, at its pose
  double error(LinkDynamics& dynamics, double h) noexcept;

  /// True if the fluid settles a link at the last sample within h [s], settlingIn().
  bool isStiff(double h) const noexcept;

  /// Replaces `u` by the velocity after the time h [s] under the loads of the last sample alone,
  /// and under generalized forces `force` (null: none). The loads grow with the square of each
  /// link's speed. In one flow that the tree can follow, the energy relative to the flow does not
  /// grow for any h. Leaves `dynamics` with the factor of M, not of H.
  void kick(LinkDynamics& dynamics, double h, CoordinatesOut u,
            const Coordinates* force = nullptr) noexcept;
  /// Predicts the velocity for the next sample, an approximation of kick(): drag slows each link
  /// down as if it were alone, and the tree takes the nearest motion, eq. (81a). @pre factor() of
  /// H, at a pose nearby
  void foresee(LinkDynamics& dynamics, double h, CoordinatesOut u) noexcept;

 private:
  /// Load of a link at its twist y relative to the flow, in its frame: -drag K y + lift.
  struct Sample {
    double drag = 0;      ///< [1/s], >= 0
    double speed = 0;     ///< |y| in the norm of K [sqrt(J)]
    Wrench lift;          ///< part of the load without power at y
    Wrench load;          ///< speed 0: whatever the twist
    Growth growth;        ///< of the resistance C
    double settling = 0;  ///< of C over K in translation [1/s]

    /// Returns the load at another twist y' with momentum K y' and speed |y'|.
    Wrench at(const Wrench& momentum, double its_speed) const;
  };

  template <class LoadOn>
  void sampleAll(LinkDynamics& dynamics, const CoordinatesIn& u, const LoadOn& load_on) noexcept;
  void applyLift(LinkDynamics& dynamics, CoordinatesOut u) noexcept;

  const LinkTree& tree_;
  std::vector<Sample> samples_;
  std::vector<double> drags_;
  std::vector<Wrench> drag_impulses_, lift_impulses_, load_errors_;
  std::vector<InertiaBlocks> resistances_;  ///< C of the links at the last sample
  bool has_resistance_ = false;             ///< a link of the last sample has one
  Coordinates change_, flow_;
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
