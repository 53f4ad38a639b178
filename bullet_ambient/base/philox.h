#pragma once

#include <array>
#include <cstdint>

namespace ambient {

using RandomBlock = std::array<std::uint64_t, 4>;

/// Philox4x64-10 (Salmon, Moraes, Dror and Shaw, 2011): four random numbers as a function of a
/// counter and a key.
RandomBlock philox(const RandomBlock& counter, const std::array<std::uint64_t, 2>& key) noexcept;

/// Uniform number in [0, 1), a multiple of 2^-53, of one number of a block.
inline double uniformOf(std::uint64_t bits) noexcept {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace ambient
