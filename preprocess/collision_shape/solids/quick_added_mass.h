#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/collision_shape/solids/solid.h"

namespace ambient {

/// Added mass of a solid about the shape's origin, per unit density, without solving its flow: the
/// closed form if there is one, else that of the equivalent ellipsoid; of a united solid that is
/// far from one, such as a dumbbell, the sum of its parts'. Cost: that of mass properties.
Matrix6 quickAddedMass(const Solid& solid);

}  // namespace ambient
