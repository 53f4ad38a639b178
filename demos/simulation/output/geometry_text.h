#pragma once

#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {

/// Text of geometry.json: data for a viewer of trajectory.csv to draw the bodies and the slip on
/// their faces. Lengths have the digits of a float.
std::string makeGeometryText(const Scene& scene, const std::vector<PreparedBody>& bodies);

}  // namespace ambient
