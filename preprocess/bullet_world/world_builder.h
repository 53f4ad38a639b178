#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "preprocess/builder/fluid_body_builder.h"

namespace ambient {

/// Settings for making the fluid bodies of a world.
struct WorldBuildSettings {
  PotentialFlowSettings flow{false, kDefaultPanels};  ///< as in BuildSettings
  bool tables = true;                                 ///< as in CollisionShapeSettings
  bool holds = true;                                  ///< likewise
  bool strict = false;                                ///< likewise
  bool reuse = true;  ///< true: keep a file that was made from the same geometry and settings
};

/// Result for one shape.
struct WorldShapeResult {
  enum class Status { kBuilt, kKept, kFailed };

  std::string name;
  std::vector<std::string> bodies;
  std::filesystem::path file;  ///< the .ambient file
  Status status = Status::kFailed;
  std::string message;                ///< why it failed
  std::vector<std::string> warnings;  ///< about a shape that was built, one line each
  double seconds = 0;
  std::size_t faces = 0;
  Vector3 extents = Vector3::Zero();  ///< of the bounding box [m]
  double volume = 0;                  ///< [m^3]
};

/// Results for a world.
struct WorldBuild {
  std::vector<WorldShapeResult> shapes;
  int lost_bodies = 0;  ///< bodies whose shape Bullet's importer does not know
  int multibodies = 0;  ///< multibodies, which the importer does not read
};

/// Makes `folder`/<name>.ambient of every distinct collision shape of a dynamic body in a .bullet
/// file; the folder is made if there is none. A shape that fails does not stop the others and
/// leaves its file as it was. `onBegin` is called with the name of each shape before its turn.
/// @throws std::runtime_error in one line that names the file, if it cannot be read, or the folder.
WorldBuild buildWorld(const std::filesystem::path& file, const std::filesystem::path& folder,
                      const WorldBuildSettings& settings,
                      const std::function<void(const std::string&)>& onBegin);

}  // namespace ambient
