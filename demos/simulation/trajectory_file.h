#pragma once

#include <filesystem>
#include <string>

#include "demos/analysis/motion_sample.h"
#include "demos/simulation/output_files.h"

namespace ambient {

/// First line of trajectory.csv; one row per body and output step, in the order of the scene.
extern const char* const kTrajectoryHeader;

/// One row of trajectory.csv with its line break, 17 significant digits.
std::string trajectoryRow(const std::string& body, const MotionSample& sample);

/// trajectory.csv while it grows. Nothing remains of it without commit().
class TrajectoryFile {
 public:
  /// @throws std::runtime_error if it cannot be written.
  explicit TrajectoryFile(const std::filesystem::path& file);

  void add(const std::string& body, const MotionSample& sample) {
    file_.write(trajectoryRow(body, sample));
  }
  void commit() { file_.commit(); }

 private:
  OutputFile file_;
};

}  // namespace ambient
