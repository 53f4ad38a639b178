#pragma once

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Interpolates between two samples: cubic Hermite in position and rotation vector, linear in the
/// twist. For smooth motion the error of the pose is of fourth order in the interval. At either
/// end the result is the sample, bit for bit.
/// @pre from.time <= time <= to.time
MotionSample interpolateMotion(const MotionSample& from, const MotionSample& to, double time);

}  // namespace ambient
