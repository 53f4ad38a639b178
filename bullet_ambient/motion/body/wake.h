#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Motion that the wake of a smooth body has taken up, w of docs/theory.md eq. (51b): in world
/// axes, relative to the ambient flow.
struct Wake {
  Twist velocity_W;
  bool has_begun = false;  ///< false: it is the motion itself when the body is first met
};

/// A motion over one step as the wake sees it.
struct WakeStep {
  Twist velocity_W;   ///< of the body, relative to the ambient flow
  double area = 0;    ///< of its surface [m^2]
  double volume = 0;  ///< [m^3]
  double duration = 0;
};

/// Returns the share in [0, 1] of a developed wake that the motion has at the start of the step,
/// eq. (51c), and lets the wake follow it over the step. 1 in steady motion; 0 at a reversal.
double developWake(const WakeStep& step, Wake& wake) noexcept;

}  // namespace ambient
