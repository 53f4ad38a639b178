#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Computes the area of the body's silhouette along an axis [m^2]: what stands in the way of the
/// flow, once where parts stand behind each other. Exact to 1e-3. Cost: some ms.
double frontalArea(const FluidBody& body, const Vector3& axis);

/// Sets body.drag from drag coefficients that were measured along the axes of F, on the frontal
/// areas.
void setMeasuredDrag(const Vector3& coefficients, FluidBody& body);

}  // namespace ambient
