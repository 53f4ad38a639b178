#pragma once

#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"

namespace ambient {

/// First line of trajectory.csv; one row per body and output step, in the order of the scene.
constexpr const char* kTrajectoryHeader = "time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz";

/// One row of trajectory.csv with its line break, 17 significant digits.
std::string trajectoryRow(const std::string& body, const MotionSample& sample);

/// The text of trajectory.csv: `motion` holds the samples of each body of the scene.
std::string makeTrajectoryText(const Scene& scene,
                               const std::vector<std::vector<MotionSample>>& motion);

}  // namespace ambient
