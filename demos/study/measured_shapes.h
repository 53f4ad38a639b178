#pragma once

#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// The shapes of data/reality/measurements.json, by their words, without added mass. Of unit
/// chord, height or edge, round ones of unit diameter; axis and normal of a plate along z, chord
/// along x, what is long along y.
/// `size`: span of a plate, length of a cylinder, spheroid or drop, depth of a rod, half angle of a
/// cone [deg]; not used by the others.
/// @throws std::invalid_argument naming a shape that is not known.
FluidBody makeMeasuredShape(const std::string& type, double size);

}  // namespace ambient
