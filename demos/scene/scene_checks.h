#pragma once

#include "demos/scene/scene.h"

namespace ambient {

/// Checks everything about a scene that a schema cannot say.
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void checkScene(const Scene& scene);

/// Largest deviation of an orientation's norm from 1 that counts as rounding of printed digits.
constexpr double kQuaternionTolerance = 1e-6;

/// Largest excess of a separation angle over its limits that counts as rounding of printed digits
/// [rad].
constexpr double kAngleTolerance = 1e-6;

}  // namespace ambient
