#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Error of a level against all faces, both in the faces' units about their origin: over motions
/// that the fit did not see, and after local ascent from the worst of them. Not a bound.
LoadLevelError measureError(const LoadLevel& level, const FaceTable& faces);

}  // namespace ambient
