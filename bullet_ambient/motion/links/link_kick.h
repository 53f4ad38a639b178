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

}  // namespace ambient
