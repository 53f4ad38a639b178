#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Measures the error of a level against the sum over all faces, both in the faces' units about
/// their origin. Uses motions that the fit did not use, and local ascent from the worst of them.
/// The result is not a bound.
LoadLevelError measureError(const LoadLevel& level, const FaceTable& faces);

}  // namespace ambient
