#pragma once

#include <cstdint>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Pseudo-random numbers, the same on every machine.
class ArbitraryNumbers {
 public:
  explicit ArbitraryNumbers(std::uint64_t seed) : state_(seed) {}
  double uniform();  ///< in [0, 1)
  Vector3 direction();

 private:
  std::uint64_t state_;
};

/// Samples a motion (w, v) with |w|^2 + |v|^2 = 1 in units of a level: v and w in independent
/// directions, uniform over the sphere, and atan(|w| / |v|) uniform from 0 to pi/2.
Vector6 sampleMotion(ArbitraryNumbers& numbers);

}  // namespace ambient
