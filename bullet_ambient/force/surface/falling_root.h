#pragma once

#include <cmath>

namespace ambient {

/// Two places of a function of one variable, and its values there.
struct Between {
  double near, at_near, far, at_far;
};

/// Finds the place between two at which a function is zero, that falls from one to the other or
/// rises: by false position, with half the value at an end that stays (Illinois). @pre the values
/// have different signs
/// @param accuracy of the value
template <class Function>
double fallingRoot(Between b, double accuracy, const Function& function) {
  constexpr int kMostSteps = 60;
  int side = 0;
  double place = b.far;
  for (int i = 0; i < kMostSteps; ++i) {
    place = (b.near * b.at_far - b.far * b.at_near) / (b.at_far - b.at_near);
    const double at = function(place);
    if (std::abs(at) <= accuracy) break;
    if ((at > 0) == (b.at_near > 0)) {
      b.near = place;
      b.at_near = at;
      if (side == 1) b.at_far /= 2;
      side = 1;
    } else {
      b.far = place;
      b.at_far = at;
      if (side == -1) b.at_near /= 2;
      side = -1;
    }
  }
  return place;
}

}  // namespace ambient
