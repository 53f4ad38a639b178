#pragma once

#include <optional>
#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/collision_shape/convex_solids.h"
#include "preprocess/collision_shape/shape_part.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The added mass of a part about its own origin, in its axes, per unit density, if the tables of
/// simple shapes have it.
std::optional<Matrix6> tabulatedAddedMass(const ShapePart& part);

/// The solids that the parts of a shape are, in its frame. Solids share the faces.
/// @throws std::runtime_error in one line that begins with the part's name, for one that cannot be
/// a body in a fluid.
std::vector<Solid> makeSolids(const std::vector<ShapePart>& parts,
                              const SolidResolution& resolution);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
