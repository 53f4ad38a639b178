#pragma once

#include <cstdint>

#include "bullet_ambient/base/philox.h"

namespace ambient {

/// Uses of random numbers, which do not meet.
enum class RandomStream : std::uint64_t { kVariations, kBiases, kNoise, kGust };

/// Place of random numbers in the life of a world.
struct RandomPlace {
  std::uint64_t seed = 0;
  RandomStream stream = RandomStream::kVariations;
  std::uint64_t episode = 0, step = 0;
};

/// Random numbers one after another from their place on. The k-th is a function of place and k.
class RandomNumbers {
 public:
  explicit RandomNumbers(const RandomPlace& place) noexcept : place_(place) {}

  double uniform() noexcept;  ///< in [0, 1), a multiple of 2^-53
  /// Mean 0 and variance 1, by Box and Muller; takes two uniform ones.
  double normal() noexcept;

 private:
  RandomPlace place_;
  std::uint64_t drawn_ = 0;
  RandomBlock block_{};
};

}  // namespace ambient
