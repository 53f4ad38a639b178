#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"

namespace ambient {

/// Creates a folder with its parents if needed. The destructor removes the folders created by this
/// object if they are empty, unless keep() was called.
class OutputFolder {
 public:
  /// @throws std::runtime_error naming the folder and why it cannot be made.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  void keep() { made_.clear(); }

  /// Folders created by this object, outermost first.
  const std::vector<std::filesystem::path>& made() const { return made_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;
};

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

/// Text of geometry.json: data for a viewer of trajectory.csv to draw the bodies and the slip on
/// their faces. Lengths have the digits of a float.
std::string makeGeometryText(const Scene& scene, const std::vector<PreparedBody>& bodies);

/// Text of summary.json: numbers of the scene, computational work, and for each body its path and,
/// if it is a plate, its falling mode.
std::string makeSummary(const Scene& scene, const std::vector<PreparedBody>& bodies,
                        const RunRecord& record);

}  // namespace ambient
