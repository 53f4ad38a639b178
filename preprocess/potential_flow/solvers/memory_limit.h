#pragma once

#include <Eigen/Core>

namespace ambient {

/// Returns the memory limit [bytes]: the setting, or the available memory if the setting is 0.
double memoryLimit(double setting);

/// @throws std::runtime_error in one line with both numbers if `bytes` is above `limit`.
void requireMemory(Eigen::Index panels, double bytes, double limit);

/// Reports that memory was not available. @throws std::runtime_error in one line, with the needed
/// `bytes` if above 0.
[[noreturn]] void raiseOutOfMemory(Eigen::Index panels, double bytes);

}  // namespace ambient
