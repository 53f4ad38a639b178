#pragma once

#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/fluid_drawing.h"
#include "bullet_ambient/bullet/precision_check.h"

class btIDebugDraw;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Draws one body as it moves now. The total wrench is that of pressure, friction (after the
/// passivity guard) and buoyancy; the inertia of the fluid is no part of it. @pre it is in a fluid,
/// alive and dynamic.
void drawFluid(const AmbientBody& ambient, const FluidDrawing& what, btIDebugDraw& drawer);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
