#pragma once

#include <cstdint>

namespace ambient {

// Law of skin friction, docs/theory.md eq. (16): C_f = 0.0576 Re^(-1/5), Re with the slip speed,
// the turbulent 1/5-power law. The functions for kernels serve numbers and vectors of numbers with
// the same roundings and without division: the same bits everywhere.

constexpr double kFrictionCoefficient = 0.0576;
constexpr double kReynoldsExponent = -1.0 / 5;

/// x^(-1/5) for normal x > 0, to 1 unit in the last place; finite for x = 0 and subnormal x, so
/// that 0 * reynoldsPower(0) is 0. `Bits`: the unsigned integers of the same shape.
template <class Bits = std::uint64_t, class Real>
inline Real reynoldsPower(Real x) {
  static_assert(sizeof(Bits) == sizeof(Real), "Bits and Real must have the same shape");
  // The bit pattern of a double is 2^52 (log2(x) + 1023), with an error of log2(x) up to 0.09: a
  // linear map of the patterns is a power law. The map is evaluated in double arithmetic, on the
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

/// Returns |u|^(-6/5) in single precision, relative error 3e-7; input: a normal |u|^2 > 0. Finite
/// for 0. `Ints`: integers of the same shape; `plusProduct(c, a, b)`: c + a b, rounded once.
template <class Ints, class Floats, class PlusProduct>
inline Floats slipPower(Floats slip_sq, const PlusProduct& plusProduct) {
  // The bit pattern is 2^23 (log2(x) + 127), as in reynoldsPower() for double.
  constexpr float kOffset = 152.48f * 0x1p23f;
  Ints bits;
  __builtin_memcpy(&bits, &slip_sq, sizeof bits);
  const auto line = [&](float at_zero, float fall, Floats z) {
    return plusProduct(Floats{} + at_zero, Floats{} - fall, z);
  };
  bits = __builtin_convertvector(line(kOffset, 0.2f, __builtin_convertvector(bits, Floats)), Ints);
  Floats r;
  __builtin_memcpy(&r, &bits, sizeof r);
  const Floats square = r * r;
  const Floats cube = square * r;
  // x r^5 lies in [1.399, 1.885]; the minimax polynomial of its power -3/5 leaves 1.1e-7.
  const Floats z = plusProduct(Floats{} - 1.625f, slip_sq * cube, square);
  const Floats z2 = z * z;
  const Floats high =
      plusProduct(line(0.135814669f, 0.0725031383f, z), z2, line(0.0412350679f, 0.0221427742f, z));
  return cube * plusProduct(line(0.747288029f, 0.275921004f, z), z2, high);
}

}  // namespace ambient
