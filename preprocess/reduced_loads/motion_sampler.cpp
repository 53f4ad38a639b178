#include "preprocess/reduced_loads/motion_sampler.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {

double ArbitraryNumbers::uniform() {  // SplitMix64, Steele et al. 2014
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

Vector3 ArbitraryNumbers::direction() {
  for (;;) {
    const double x = 2 * uniform() - 1, y = 2 * uniform() - 1, z = 2 * uniform() - 1;
    const double length_sq = x * x + y * y + z * z;
    if (length_sq <= 1 && length_sq > 1e-4) return Vector3(x, y, z) / std::sqrt(length_sq);
  }
}

Vector6 sampleMotion(ArbitraryNumbers& numbers) {
  const double angle = kPi / 2 * numbers.uniform();
  Vector6 x;
  x << portable::sin(angle) * numbers.direction(), portable::cos(angle) * numbers.direction();
  return x;
}

}  // namespace ambient
