#pragma once

#include <vector>

#include "preprocess/floating/floating_body.h"

namespace ambient {

/// Finds all attitudes in which a body floats, largest share first; none if it sinks. Attitudes of
/// equal energy count as one. Method: descents of the energy from some hundred attitudes. Cost: 0.1
/// s for a hull of 1000 triangles.
/// @throws std::invalid_argument, naming value and limit, if mass, inertia, density or gravity are
/// not physical, or the shape has no surface or no volume.
std::vector<FloatingAttitude> findFloatingAttitudes(const FloatingBody& body);

}  // namespace ambient
