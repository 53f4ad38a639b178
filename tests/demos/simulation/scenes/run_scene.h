#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/shape_builder.h"
#include "tests/support/temporary_folder.h"

namespace ambient {

/// Path of a scene of data/scenes.
inline std::filesystem::path sceneFile(const std::string& name) {
  return std::filesystem::path(AMBIENT_DATA) / "scenes" / (name + ".json");
}

inline Scene readNamedScene(const std::string& name,
                            const std::vector<SceneOverride>& overrides = {}) {
  return readScene(sceneFile(name), overrides);
}

/// Runs a scene with bodies prepared earlier.
inline RunRecord runPrepared(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  return runScene(scene, bodies);
}

inline std::vector<PreparedBody> prepare(const Scene& scene) {
  SceneBodyCache cache;
  return prepareBodies(scene, cache);
}

/// Prepares the bodies of a scene; scenes with equal shapes share the fluid body.
inline std::vector<PreparedBody> prepareSharing(const Scene& scene) {
  static SceneBodyCache cache;
  return prepareBodies(scene, cache);
}

inline RunRecord runSharing(const Scene& scene) {
  return runPrepared(scene, prepareSharing(scene));
}

/// Motion of the first body.
inline std::vector<MotionSample> motionOf(const std::string& scene,
                                          const std::string& model = "ambient") {
  return runSharing(readNamedScene(scene, {{"model", model}})).motion[0];
}

/// Scene with the first body's flow solved on its mesh triangles only: faster, within a percent.
/// Writes the .ambient file into the folder.
inline Scene readCoarseScene(const std::string& name, const TemporaryFolder& folder,
                             std::vector<SceneOverride> overrides = {}) {
  ShapeBuildSettings settings;
  settings.name = name;
  settings.origin = Vector3::Zero();
  settings.flow.max_panels = 0;
  const std::filesystem::path file = folder / (name + ".ambient");
  if (!std::filesystem::exists(file))
    writeFluidBody(buildShape(readNamedScene(name, overrides).bodies[0].shape, settings).body,
                   file);
  overrides.push_back(
      {"bodies.0.shape", R"({"type": "fluid_body", "file": ")" + file.string() + "\"}"});
  return readNamedScene(name, overrides);
}

inline RunRecord run(const Scene& scene) { return runPrepared(scene, prepare(scene)); }

}  // namespace ambient
