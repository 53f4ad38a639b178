#pragma once

namespace ambient {

/// The nearest number of single precision, as files hold it. A function of another source, never
/// inlined: gcc 12 leaves (double)(float)x out for neighbours in memory that it computes together.
double roundedToSingle(double value) noexcept;

}  // namespace ambient
