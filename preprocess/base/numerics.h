#pragma once

#include <cstdint>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

inline Matrix6 symmetricPart(const Matrix6& K) { return (K + K.transpose()) / 2; }

/// Nearest symmetric positive semi-definite matrix: negative eigenvalues become 0. Discretisation
/// leaves tiny negative eigenvalues in the inertia of a fluid where the true ones are zero.
/// @pre rotation and translation block are of similar size: unit of length = size of the body
Matrix6 positivePart(const Matrix6& K);

/// Makes Eigen's products and factorisations of large matrices give the same bits on every
/// machine. Eigen sums in blocks that fit the processor's caches. The first call sets the cache
/// sizes to 32 kB, 1 MB and 8 MB for the whole program. Call before the first such product.
void fixBlocksOfLargeProducts();

/// Pseudo-random numbers, the same on every machine: SplitMix64 (Steele, Lea and Flood 2014).
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  /// Returns the next number in [0, 1).
  double uniform() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

/// Gauss-Legendre rule of n points on [0, 1]: places, and weights that sum up to 1.
struct GaussRule {
  static constexpr int kMost = 5;
  int count;
  double place[kMost], weight[kMost];
};

/// The rules of 1 to GaussRule::kMost points.
extern const GaussRule kGaussRules[GaussRule::kMost];

}  // namespace ambient
