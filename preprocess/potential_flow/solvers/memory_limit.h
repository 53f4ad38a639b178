#pragma once

#include <Eigen/Core>

namespace ambient {

/// Bytes that may be used: the setting, or what the machine has available when it is 0.
double memoryLimit(double setting);

/// @throws std::runtime_error in one line with both numbers if `bytes` is above `limit`.
void requireMemory(Eigen::Index panels, double bytes, double limit);

/// Says what was needed, if that is known, when it was not there.
[[noreturn]] void raiseOutOfMemory(Eigen::Index panels, double bytes);

}  // namespace ambient
