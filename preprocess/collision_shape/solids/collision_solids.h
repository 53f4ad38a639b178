#pragma once

#include <vector>

#include "preprocess/collision_shape/solids/hull_solids.h"
#include "preprocess/shape/shape_facts.h"

namespace ambient {

/// Triangles that many solids have together at most, over those aimed at, as far as they can.
constexpr int kMostOfMany = 6;

/// The added mass of a part about its own origin, in its axes, per unit density, if the tables of
/// simple shapes have it.
std::optional<Matrix6> tabulatedAddedMass(const Shape& shape);

/// The solids that the parts of a shape are, in its frame. Solids share the faces.
/// @throws std::runtime_error in one line that begins with the part's name, for one that cannot be
/// a body in a fluid.
std::vector<Solid> makeSolids(const std::vector<PlacedShape>& parts,
                              const SolidResolution& resolution);

}  // namespace ambient
