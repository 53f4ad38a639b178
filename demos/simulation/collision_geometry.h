#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "demos/simulation/prepared_body.h"
#include "preprocess/shape/shape_description.h"

namespace ambient {

/// Geometry of a dynamic body: a primitive, or the convex hull of the fluid body's surface. Frame
/// S; `fluid_origin` is F's origin in it [m].
CollisionGeometry makeDynamicGeometry(const ShapeDescription& shape, const FluidBody& fluid_body,
                                      const Vector3& fluid_origin);

/// Geometry of a static body: a primitive, or the triangles themselves.
/// @throws std::runtime_error as makeShapeMesh() and readFluidBody().
CollisionGeometry makeStaticGeometry(const ShapeDescription& shape);

}  // namespace ambient
