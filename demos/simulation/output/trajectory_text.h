#pragma once

#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"

namespace ambient {

/// First line of trajectory.csv; it has one row per output time and body, in the scene's order.
constexpr const char* kTrajectoryHeader = "time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz";

/// One row of trajectory.csv with line break; 17 significant digits.
std::string trajectoryRow(const std::string& body, const MotionSample& sample);

/// Text of trajectory.csv; `motion`: samples of each body, see RunRecord::motion. `further`:
/// columns as RunRecord::log, each after a comma as their names are; none: there are none.
std::string makeTrajectoryText(const Scene& scene,
                               const std::vector<std::vector<MotionSample>>& motion,
                               const std::string& further_names = "",
                               const std::vector<std::vector<std::string>>& further = {});

}  // namespace ambient
