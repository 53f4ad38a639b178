#pragma once

#include "preprocess/collision_shape/form_body.h"

namespace ambient {

/// Takes a cylinder of the same volume and height for a form that is a single hull whose points are
/// two polygons of many corners around one of its axes, as importers make of cylinders. On 24
/// corners, the fewest, its added mass across is off by 0.07 %, on 32 by 0.03 % (conformal map of a
/// regular polygon). Other forms stay as they are: among others a hull stays a polyhedron, of which
/// unions are soon made. Cost O(n log n).
ShapeForm recognised(ShapeForm form);

}  // namespace ambient
