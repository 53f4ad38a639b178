#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ambient {

/// FNV-1a hash, 64 bits, of a byte sequence: detects accidental change, not forgery. Fowler, Noll
/// and Vo; constants of draft-eastlake-fnv. Cost: about 1 ns per byte.
constexpr std::uint64_t fnv1a64(std::string_view bytes) noexcept {
  constexpr std::uint64_t kOffsetBasis = 0xcbf29ce484222325u;
  constexpr std::uint64_t kPrime = 0x100000001b3u;
  std::uint64_t hash = kOffsetBasis;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return hash;
}

/// A hash as 16 hexadecimal digits.
inline std::string hashText(std::uint64_t hash) {
  std::string text(16, '0');
  for (std::size_t i = text.size(); i-- > 0; hash >>= 4) text[i] = "0123456789abcdef"[hash & 15];
  return text;
}

}  // namespace ambient
