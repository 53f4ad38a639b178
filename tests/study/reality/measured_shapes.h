#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Makes a shape of data/reality/measurements.json by its `type`. Chord, height or edge are 1;
/// round shapes have unit diameter. Axis and normal of a plate are along z, the chord along x,
/// length along y. `size`: span of a plate, length of a cylinder, spheroid or drop, depth of a rod,
/// half angle of a cone [deg]. `width` and `thickness` of an ellipsoid or grain of length 1 (y, z;
/// x). `profile`: (radius, z) of a turned body, from bottom to top.
/// @throws std::invalid_argument that names an unknown shape, or std::runtime_error.
FluidBody makeMeasuredShape(const nlohmann::json& shape);

}  // namespace ambient
