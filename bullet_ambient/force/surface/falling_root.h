#pragma once

#include <cmath>

namespace ambient {

/// Finds where a function is zero that falls from one end to the other, or rises: by false
/// position, with half the value at an end that stays (Illinois). @pre the values at the ends have
/// different signs
/// @param accuracy of the value
template <class Function>
double fallingRoot(double near, double at_near, double far, double at_far, double accuracy,
                   const Function& function) {
  constexpr int kMostSteps = 60;
  int side = 0;
  double root = far;
  for (int i = 0; i < kMostSteps; ++i) {
    root = (near * at_far - far * at_near) / (at_far - at_near);
    const double at = function(root);
    if (std::abs(at) <= accuracy) break;
    if ((at > 0) == (at_near > 0)) {
      near = root;
      at_near = at;
      if (side == 1) at_far /= 2;
      side = 1;
    } else {
      far = root;
      at_far = at;
      if (side == -1) at_near /= 2;
      side = -1;
    }
  }
  return root;
}

}  // namespace ambient
