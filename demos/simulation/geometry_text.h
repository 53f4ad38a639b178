#pragma once

#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"

namespace ambient {

/// The text of geometry.json: what a viewer of trajectory.csv needs to draw the bodies and the
/// slip on their faces. Lengths have the digits of a float.
/// @throws std::runtime_error as makeBodySurface().
std::string makeGeometryText(const Scene& scene, const std::vector<PreparedBody>& bodies);

}  // namespace ambient
