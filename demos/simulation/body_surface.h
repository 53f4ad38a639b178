#pragma once

#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"

namespace ambient {

/// The triangles of a body for drawing: the shape's axes, origin at the centre of mass, as the
/// poses of the trajectory have it [m].
/// @throws std::runtime_error as makeShapeMesh() and readFluidBody().
Surface makeBodySurface(const BodyDef& def, const PreparedBody& prepared);

}  // namespace ambient
