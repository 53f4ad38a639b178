#pragma once

#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Makes a shape of data/reality/measurements.json by name, without added mass. Chord,
/// height or edge are 1; round shapes have unit diameter. Axis and normal of a plate are
/// along z, the chord along x, length along y. `size`: span of a plate, length of a
/// cylinder, spheroid or drop, depth of a rod, half angle of a cone [deg]. Other shapes
/// ignore `size`.
/// @throws std::invalid_argument that names an unknown shape.
FluidBody makeMeasuredShape(const std::string& type, double size);

}  // namespace ambient
