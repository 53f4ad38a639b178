#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"

namespace ambient {

/// Runs of the cases of data/reality/measurements_at_sea.json, each made once.
class SeaRuns {
 public:
  /// @throws std::runtime_error in one line that names the file.
  explicit SeaRuns(const std::filesystem::path& measurements);

  /// The whole file.
  const nlohmann::json& data() const { return data_; }
  const nlohmann::json& rows() const { return data_.at("rows"); }

  /// Value of a row by the library. @throws std::exception that names the row.
  double compute(const nlohmann::json& row);

  /// Coordinates of the cases that have measured curves, up to the last measured time:
  /// index of the curve, time, (y - balance)/scale.
  std::string curves();

 private:
  struct Run {
    Scene scene;
    std::vector<PreparedBody> bodies;
    std::vector<MotionSample> motion;  ///< of the first body
  };

  const Run& run(const std::string& name);
  double valueOf(const nlohmann::json& measured, const Run& of) const;

  std::filesystem::path file_;
  nlohmann::json data_;
  SceneBodyCache bodies_;
  std::map<std::string, Run> runs_;
};

}  // namespace ambient
