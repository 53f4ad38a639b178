#pragma once

#include <array>
#include <cstdint>

namespace ambient {

using RandomBlock = std::array<std::uint64_t, 4>;

/// Philox4x64-10 (Salmon, Moraes, Dror and Shaw, 2011): four random numbers as a function of a
/// counter and a key.
inline RandomBlock philox(const RandomBlock& counter,
                          const std::array<std::uint64_t, 2>& key) noexcept {
  __extension__ typedef unsigned __int128 Product;
  const auto high = [](Product x) { return static_cast<std::uint64_t>(x >> 64); };
  constexpr int kRounds = 10;
  constexpr std::uint64_t kFirst = 0xD2E7470EE14C6C93, kSecond = 0xCA5A826395121157;
  constexpr std::uint64_t kWeyl0 = 0x9E3779B97F4A7C15, kWeyl1 = 0xBB67AE8584CAA73B;
  RandomBlock c = counter;
  std::uint64_t key0 = key[0], key1 = key[1];
  for (int round = 0; round < kRounds; ++round, key0 += kWeyl0, key1 += kWeyl1) {
    const Product a = static_cast<Product>(kFirst) * c[0], b = static_cast<Product>(kSecond) * c[2];
    c = {high(b) ^ c[1] ^ key0, static_cast<std::uint64_t>(b), high(a) ^ c[3] ^ key1,
         static_cast<std::uint64_t>(a)};
  }
  return c;
}

/// Uniform number in [0, 1), a multiple of 2^-53, of one number of a block.
inline double uniformOf(std::uint64_t bits) noexcept {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace ambient
