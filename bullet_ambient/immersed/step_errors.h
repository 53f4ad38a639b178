#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// Accumulated error E of a body's steps, as of a random walk that forgets old steps:
///
///   E^2 <- (1 - 1/n) E^2 + e^2
///
///   e  error of the velocity in a step, relative to the motion; 0 where it is within the tolerance
///   n  steps that count
class StepErrors {
 public:
  /// Limit of E above which the motion is visibly wrong. A box in water that chatters at 1/60 s has
  /// 0.06, and its path is off by 4 % after 3 s; a winged seed has 0.036 and is off by 0.6 %.
  static constexpr double kLargest = 0.05;

  /// Adds the error of a step. Returns true once: for the first step after which E exceeds
  /// kLargest.
  bool add(double error) noexcept {
    squares_ += error * error - squares_ / kSteps;
    if (was_large_ || !(squares_ > kLargest * kLargest)) return false;
    return was_large_ = true;
  }

 private:
  static constexpr double kSteps = 64;

  double squares_ = 0;  // E^2
  bool was_large_ = false;
};

AMBIENT_END
