#pragma once

#include "bullet_ambient/motion/surface/hold_water.h"

namespace ambient {

/// Lets the pumps run, and water pass through the openings, one after the other, for the duration
/// of a passage; docs/theory.md eq. (138) to (140), where water shuts off air (143) to (147). No
/// level passes that on the other side but by a difference of pressures. Returns the inertia in F
/// of the water that has come from outside, per unit density; it was at rest there.
/// @param plane_F of the water outside
/// @param states one of each hold
Matrix6 exchangeWater(const HoldShapes& holds, const SurfacePlane& plane_F, const Passage& passage,
                      HoldState* states) noexcept;

}  // namespace ambient
