#pragma once

#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/sphere_table.h"

namespace ambient {

/// Returns true if the loads on a sphere need a table: friction, and pressure at separation angles
/// above pi/2, have no closed form for every spin.
bool needsSphereTable(const LoadSettings& settings) noexcept;

/// Pressure and friction on a smooth sphere, about its centre and for the twist at its centre: the
/// limit of computeFaceLoads() for fine meshes. Pressure at alpha = pi/2 is exact; other results
/// have the errors of SphereTable. The power is never positive, up to rounding. docs/theory.md eq.
/// (40) to (42). radius [m]; reference_length [m]: sqrt(area).
/// @pre `table` was made for the separation angle; may be null if needsSphereTable() is false
FaceLoads computeSphereLoads(const SphereTable* table, double radius, double reference_length,
                             const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
