#include "preprocess/bullet_world/world_builder.h"

#include <chrono>

#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/reuse.h"
#include "preprocess/bullet_world/world_file.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

using Status = WorldShapeResult::Status;

void build(const WorldShape& shape, const WorldBuildSettings& settings, WorldShapeResult& result) {
  CollisionShapeSettings shape_settings;
  shape_settings.name = shape.name;
  shape_settings.flow = settings.flow;
  shape_settings.tables = settings.tables;
  shape_settings.strict = settings.strict;
  shape_settings.report = [&](const std::string& text) { result.warnings.push_back(text); };
  const Provenance provenance = describeCollisionShape(*shape.shape, shape_settings);
  std::optional<FluidBody> body;
  if (settings.reuse) body = readIfSame(result.file, shape.name, provenance);
  result.status = body ? Status::kKept : Status::kBuilt;
  if (!body) {
    body = makeFluidBody(*shape.shape, shape_settings);
    writeFluidBody(*body, result.file);
  }
  result.faces = body->faces.size();
  result.extents = extentsOf(*body);
  result.volume = body->volume;
}

}  // namespace

WorldBuild buildWorld(const std::filesystem::path& file, const std::filesystem::path& folder,
                      const WorldBuildSettings& settings,
                      const std::function<void(const std::string&)>& onBegin) {
  const WorldFile world(file);
  std::error_code no_folder;
  std::filesystem::create_directories(folder, no_folder);
  if (no_folder)
    raiseInputError(folder.string(), "the folder cannot be made: ", no_folder.message());
  WorldBuild built;
  built.lost_bodies = world.lostBodies();
  built.multibodies = world.multibodies();
  for (const WorldShape& shape : world.dynamicShapes()) {
    const auto start = std::chrono::steady_clock::now();
    WorldShapeResult result;
    result.name = shape.name;
    result.bodies = shape.bodies;
    result.file = folder / (shape.name + ".ambient");
    onBegin(shape.name);
    try {
      build(shape, settings, result);
    } catch (const std::exception& error) {
      result.status = Status::kFailed;
      result.message = error.what();
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    built.shapes.push_back(result);
  }
  return built;
}

}  // namespace ambient
