#pragma once

/// Elementary functions with the same bits on every x86-64 machine and by every compiler.
///
/// The C library has one variant of each function per type of processor, and the variants
/// differ in the last bit. The functions here consist of IEEE additions, multiplications,
/// divisions and square roots in double, in a fixed order. Angles are in rad. The comment of each
/// function states its largest error in units in the last place (ulp), checked by tests/
/// bullet_ambient/base/base_test.cpp. NaN arguments give NaN; results out of range are
/// infinite or zero, as in the C library.
namespace ambient::portable {

double sin(double angle) noexcept;  ///< 0.8 ulp
double cos(double angle) noexcept;  ///< 0.8 ulp
double tan(double angle) noexcept;  ///< 2.2 ulp

/// Sine and cosine of one angle.
struct SineCosine {
  double sine = 0, cosine = 1;
};
SineCosine sineAndCosine(double angle) noexcept;  ///< same bits as sin() and cos(), quicker

double asin(double sine) noexcept;          ///< 1.8 ulp, in [-pi/2, pi/2]
double acos(double cosine) noexcept;        ///< 1.6 ulp, in [0, pi]
double atan(double tangent) noexcept;       ///< 0.6 ulp, in [-pi/2, pi/2]
double atan2(double y, double x) noexcept;  ///< 0.6 ulp, in [-pi, pi]; signs of zeros count

double exp(double exponent) noexcept;               ///< 0.7 ulp
double expm1(double exponent) noexcept;             ///< 1.1 ulp; e^exponent - 1
double log(double x) noexcept;                      ///< 0.9 ulp; natural logarithm
double log1p(double x) noexcept;                    ///< 0.6 ulp; log(1 + x)
double atanh(double x) noexcept;                    ///< 2.6 ulp
double pow(double base, double exponent) noexcept;  ///< 0.7 ulp

double cbrt(double x) noexcept;                       ///< 0.6 ulp
double hypot(double x, double y) noexcept;            ///< 1.2 ulp; sqrt(x^2 + y^2)
double hypot(double x, double y, double z) noexcept;  ///< 1.6 ulp; sqrt(x^2 + y^2 + z^2)

}  // namespace ambient::portable

namespace ambient {

/// Rounds to the nearest number of single precision, which files hold. Never inlined: gcc 12 drops
/// the conversion (double)(float)x when it vectorises over neighbours in memory.
double roundedToSingle(double value) noexcept;

}  // namespace ambient
