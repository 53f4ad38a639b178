#pragma once

#include "bullet_ambient/fluid_body/load_level.h"
#include "bullet_ambient/force/face_loads.h"

namespace ambient {

/// The total of computeFaceLoads() on the clusters of a level, docs/theory.md eq. (36) to (39),
/// with the error that the level states. Arguments as there; `settings.separation_cosine` must be
/// that of the level. The pressure may feed energy to the body: guard it. Cost: level.cost faces,
/// whatever the mesh; allocates nothing. The same bits on every machine.
Wrench computeLevelLoad(const LoadLevel& level, double reference_length,
                        const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
