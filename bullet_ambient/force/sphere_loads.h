#pragma once

#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

/// Whether the loads on a sphere need a table: friction, and pressure at separation angles above
/// pi/2, have no closed form for every spin.
bool needsSphereTable(const LoadSettings& settings) noexcept;

/// Pressure and friction on a smooth sphere, about its centre and for the twist there: what
/// computeFaceLoads() tends to as the faces of a mesh become fine. Pressure at alpha = pi/2 is
/// exact, the rest as exact as SphereTable. Takes energy from the body for every motion and angle,
/// up to rounding. docs/theory.md eq. (40) to (42). Radius [m]; reference_length as there.
/// @pre `table` is of the separation angle, or null where none is needed.
FaceLoads computeSphereLoads(const SphereTable* table, double radius, double reference_length,
                             const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
