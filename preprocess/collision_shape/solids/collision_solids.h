#pragma once

#include <vector>

#include "preprocess/collision_shape/solids/hull_solids.h"
#include "preprocess/shape/shape_facts.h"

namespace ambient {

/// Largest number of triangles of many solids together, over the number aimed at, as far as their
/// kinds allow.
constexpr int kMostOfMany = 6;

/// Returns the added mass of a part about its own origin, in its axes, per unit density; none if
/// the tables of simple shapes do not have it.
std::optional<Matrix6> tabulatedAddedMass(const Shape& shape);

/// Makes the solids of the parts of a shape, in the frame of the shape. The number of faces is
/// divided among them.
/// @throws std::runtime_error in one line that begins with the part's name, for one that cannot be
/// a body in a fluid.
std::vector<Solid> makeSolids(const std::vector<PlacedShape>& parts,
                              const SolidResolution& resolution);

}  // namespace ambient
