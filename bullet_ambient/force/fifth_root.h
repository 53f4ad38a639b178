#pragma once

#include <cstdint>

namespace ambient {

/// x^(-1/5) for normal x > 0, to 1 unit in the last place; finite for x = 0 and subnormal x, so
/// that 0 * inverseFifthRoot(0) is 0. Works alike on a double and on a vector of doubles (`Bits`:
/// the unsigned integers of the same shape): one division-free sequence of roundings, hence the
/// same bits everywhere.
template <class Bits = std::uint64_t, class Real>
inline Real inverseFifthRoot(Real x) {
  static_assert(sizeof(Bits) == sizeof(Real), "Bits and Real must have the same shape");
  // The bit pattern of a double is 2^52 times its logarithm to base 2 (plus 1023), up to 0.09: a
  // linear map of the patterns is a power law. It is evaluated in double arithmetic, on the
  // patterns without their last 12 bits, because vectors of 64-bit integers cannot be multiplied
  // cheaply.
  constexpr double kTwo52 = 0x1p52;
  constexpr std::uint64_t kBitsOfTwo52 = 0x4330000000000000u;
  constexpr double kOffset = 1227.68 * 0x1p40;  // 1023 (1 + 1/5) + 0.08: the flattest x r^5
  Bits bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  bits = (bits >> 12) | kBitsOfTwo52;
  Real r;
  __builtin_memcpy(&r, &bits, sizeof r);
  r = (kOffset - (r - kTwo52) * 0.2) + kTwo52;
  __builtin_memcpy(&bits, &r, sizeof bits);
  bits = bits << 12;
  __builtin_memcpy(&r, &bits, sizeof r);

  // z = x r^5 lies in [1.400, 1.883]; the minimax polynomial of z^(-1/5) there leaves 2.7e-7.
  const Real z = (x * r) * ((r * r) * (r * r));
  const Real z2 = z * z;
  r = r * ((1.342059632114351 - 0.550635878840544 * z) +
           z2 * ((0.2765077632822654 - 0.07757024719716396 * z) + 0.009019099464419067 * z2));
  // (1 - e)^(-1/5) = 1 + e/5 + 3 e^2/25 + O(e^3), and e^3 is 2e-18.
  const Real e = 1.0 - (x * r) * ((r * r) * (r * r));
  return r + (r * e) * (0.2 + 0.12 * e);
}

}  // namespace ambient
