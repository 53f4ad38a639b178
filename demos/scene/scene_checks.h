#pragma once

#include "demos/scene/scene.h"

namespace ambient {

/// Checks all conditions on a scene that the schema does not express.
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void checkScene(const Scene& scene);

/// Tolerance for the norm of an orientation: rounding of printed digits.
constexpr double kQuaternionTolerance = 1e-6;

/// Tolerance for the limits of a separation angle: rounding of printed digits
/// [rad].
constexpr double kAngleTolerance = 1e-6;

}  // namespace ambient
