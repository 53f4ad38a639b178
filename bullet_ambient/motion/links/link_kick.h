#pragma once

#include <vector>

#include "bullet_ambient/motion/links/link_dynamics.h"

namespace ambient {

/// Surface loads on the links of a tree, and what they do to its velocity, docs/theory.md eq. (81):
/// drag is implicit, link by link, and lift explicit, but without work. Has the memory that this
/// needs; all but the constructor is free of allocation.
class LinkKick {
 public:
  explicit LinkKick(const LinkTree& tree);

  /// Whether any link has loads.
  bool hasLoads() const noexcept;

  /// Evaluates the loads at u and the pose of `dynamics`, with the passivity guard.
  FlightCount sample(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept;
  /// By how much the last sample differed from what the one before it made expect, as a change of
  /// velocity in the time h over the motion: the error of docs/theory.md eq. (25). @pre kick()
  /// after that sample, at its pose
  double error(LinkDynamics& dynamics, double h) noexcept;

  /// u after the time h [s] under the loads of the last sample alone, in place. They grow with the
  /// square of each link's speed. In one flow that the tree can follow, the energy relative to it
  /// does not grow, however long the time. `dynamics` is left without factor().
  void kick(LinkDynamics& dynamics, double h, CoordinatesOut u) noexcept;
  /// Approximates kick(), for the next sample: drag slows each link down as if it was alone, and
  /// the tree takes the motion nearest to that, as in eq. (81a). @pre factor(), of H at a pose
  /// nearby
  void foresee(LinkDynamics& dynamics, double h, CoordinatesOut u) noexcept;

 private:
  /// Load of a link at its twist y relative to the flow, in its frame: -drag K y + lift.
  struct Sample {
    double drag;   ///< [1/s], >= 0
    double speed;  ///< |y| in the norm of K [sqrt(J)]; 0: no load
    Wrench lift;   ///< does no work at y

    /// Load at a twist of this momentum and speed.
    Wrench at(const Wrench& momentum, double its_speed) const;
  };

  void applyLift(LinkDynamics& dynamics, CoordinatesOut u) noexcept;

  const LinkTree& tree_;
  std::vector<Sample> samples_;
  std::vector<double> drags_;
  std::vector<Wrench> drag_impulses_, lift_impulses_, surprises_;
  Coordinates change_, flow_;
};

}  // namespace ambient
