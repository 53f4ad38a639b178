#pragma once

#include <functional>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN

/// Bodies and trees of several worlds that nothing touches, which fly side by side, and the steps
/// of these worlds, each within the one before:
///
///   rows of world 0, rows of world 1, ..., flights of all, Bullet moves world n - 1, ..., world 0
///
/// All on one thread. Allocates nothing.
class FlightQueue {
 public:
  /// `step(i)` makes a step of world i, whose solver calls goOn(); null: there are no worlds.
  explicit FlightQueue(int worlds = 0, const std::function<void(int)>* step = nullptr)
      : worlds_(worlds), step_(step) {}

  /// Adds one that flies in this substep of `time_step` [s], and its fluid; flies all that wait if
  /// they fill the lanes or if their time step is another one. A tree: prepareTree() was false.
  void add(AmbientBody& body, AmbientBodies& of, double time_step) noexcept {
    add(bodies_, body, of, time_step);
  }
  void add(AmbientTree& tree, AmbientBodies& of, double time_step) noexcept {
    add(trees_, tree, of, time_step);
  }
  /// Flies all that wait.
  void fly() noexcept;

  /// Call when the rows of a world are solved: makes the steps of the worlds that have not begun,
  /// and flies all that wait.
  void goOn() noexcept {
    while (begun_ < worlds_) (*step_)(begun_++);
    fly();
  }

 private:
  template <class Flyer>
  struct Waiting {
    Flyer* flyers[kFlightsTogether] = {};
    AmbientBodies* of[kFlightsTogether] = {};
    int count = 0;
  };
  template <class Flyer>
  void add(Waiting<Flyer>& waiting, Flyer& flyer, AmbientBodies& of, double time_step) noexcept {
    if (time_step != time_step_) fly();
    time_step_ = time_step;
    waiting.flyers[waiting.count] = &flyer;
    waiting.of[waiting.count++] = &of;
    if (waiting.count == kFlightsTogether) fly();
  }

  Waiting<AmbientBody> bodies_;
  Waiting<AmbientTree> trees_;
  double time_step_ = 0;
  int worlds_, begun_ = 0;
  const std::function<void(int)>* step_;
};

AMBIENT_END
