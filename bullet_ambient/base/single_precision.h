#pragma once

namespace ambient {

/// Rounds to the nearest number of single precision, which files hold. Never inlined: gcc 12 drops
/// the conversion (double)(float)x when it vectorises over neighbours in memory.
double roundedToSingle(double value) noexcept;

}  // namespace ambient
