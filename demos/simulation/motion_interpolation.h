#pragma once

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Motion between two samples: cubic Hermite in position and rotation vector, linear in the twist.
/// For smooth motion the pose is right to fourth order in the distance of the samples. At either
/// end the result is that sample, bit for bit.
/// @pre from.time <= time <= to.time
MotionSample interpolateMotion(const MotionSample& from, const MotionSample& to, double time);

}  // namespace ambient
