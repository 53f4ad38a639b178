#include "bullet_ambient/base/philox.h"

namespace ambient {
namespace {

__extension__ typedef unsigned __int128 Product;

Product product(std::uint64_t a, std::uint64_t b) noexcept { return static_cast<Product>(a) * b; }
std::uint64_t high(Product x) noexcept { return static_cast<std::uint64_t>(x >> 64); }

}  // namespace

RandomBlock philox(const RandomBlock& counter, const std::array<std::uint64_t, 2>& key) noexcept {
  constexpr int kRounds = 10;
  constexpr std::uint64_t kFirst = 0xD2E7470EE14C6C93, kSecond = 0xCA5A826395121157;
  constexpr std::uint64_t kWeyl0 = 0x9E3779B97F4A7C15, kWeyl1 = 0xBB67AE8584CAA73B;
  RandomBlock c = counter;
  std::uint64_t key0 = key[0], key1 = key[1];
  for (int round = 0; round < kRounds; ++round, key0 += kWeyl0, key1 += kWeyl1) {
    const Product a = product(kFirst, c[0]), b = product(kSecond, c[2]);
    c = {high(b) ^ c[1] ^ key0, static_cast<std::uint64_t>(b), high(a) ^ c[3] ^ key1,
         static_cast<std::uint64_t>(a)};
  }
  return c;
}

}  // namespace ambient
