#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// Sum E of the errors of a body's steps, like those of a random walk that forgets:
///
///   E^2 <- (1 - 1/n) E^2 + e^2
///
///   e  error of the velocity in a step, relative to the motion; 0 where it is within the tolerance
///   n  steps that count
class StepErrors {
 public:
  /// Above it the motion is wrong to the eye: a box in water that chatters at 1/60 s has 0.06 and
  /// is 4 per cent off its way in 3 s; a winged seed has 0.036 and is off by 0.6 per cent.
  static constexpr double kLargest = 0.05;

  /// Adds a step. True for the first one by which the sum is too large.
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
