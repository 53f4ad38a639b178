#pragma once

#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// The samples and as many between them as it takes that no body turns by more than an eighth of a
/// turn from one to the next: who plays them takes the shorter way round. Successive quaternions
/// have no sign change.
/// @pre times increase
std::vector<MotionSample> makeMotionKeys(const std::vector<MotionSample>& motion);

}  // namespace ambient
