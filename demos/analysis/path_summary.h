#pragma once

#include <optional>
#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Summary of the path of one body's centre of mass.
struct PathSummary {
  double length = 0;                    ///< length of the path [m]
  double largest_speed = 0;             ///< [m/s]
  double largest_height = 0;            ///< above the plane through W's origin, against gravity [m]
  double descent_speed = 0;             ///< mean over all samples [m/s], > 0 downwards
  std::optional<MotionSample> landing;  ///< first passage through that plane downwards
};

/// Summarises one path; gravity in W; without gravity "up" is +z.
PathSummary summarisePath(const std::vector<MotionSample>& samples, const Vector3& gravity);

}  // namespace ambient
