#pragma once

#include <optional>
#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Where a body has been.
struct PathSummary {
  double length = 0;                    ///< of the path of the centre of mass [m]
  double largest_speed = 0;             ///< [m/s]
  double largest_height = 0;            ///< above the plane through W's origin, against gravity [m]
  double descent_speed = 0;             ///< mean over all samples [m/s], > 0 downwards
  std::optional<MotionSample> landing;  ///< where it first came down through that plane
};

/// Sums up one path; without gravity "up" is +z.
PathSummary summarisePath(const std::vector<MotionSample>& samples, const Vector3& gravity);

}  // namespace ambient
