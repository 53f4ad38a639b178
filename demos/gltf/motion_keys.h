#pragma once

#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Inserts interpolated samples so that the body turns by at most an eighth of a turn between two
/// keys: glTF players interpolate along the shorter rotation. Successive quaternions have a
/// positive scalar product.
/// @pre times increase
std::vector<MotionSample> makeMotionKeys(const std::vector<MotionSample>& motion);

}  // namespace ambient
