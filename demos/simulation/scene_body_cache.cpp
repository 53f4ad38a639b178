#include "demos/simulation/scene_body_cache.h"

#include <optional>
#include <utility>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/builder/reuse.h"
#include "preprocess/builder/shape_builder.h"

namespace ambient {
namespace fs = std::filesystem;
namespace {

/// Whether Fluid::addAll() would find the shape as a collision shape that has a table.
bool isTabulatedSolid(const Shape& shape) {
  return std::holds_alternative<Box>(shape) || std::holds_alternative<Cylinder>(shape) ||
         std::holds_alternative<Capsule>(shape) || std::holds_alternative<Cone>(shape);
}

}  // namespace

SceneBodyCache::SceneBodyCache(fs::path folder, int threads)
    : folder_(std::move(folder)), threads_(threads) {}

std::shared_ptr<const FluidBody> SceneBodyCache::get(const ShapeDescription& shape,
                                                     const std::string& name,
                                                     int waterline_subdivisions) {
  std::string key = shape.text;
  if (waterline_subdivisions != 0) key += ", waterline " + std::to_string(waterline_subdivisions);
  std::shared_ptr<const FluidBody>& known = by_text_[key];
  if (!known) known = readOrBuild(shape, name, waterline_subdivisions);
  return known;
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOr(const std::string& name,
                                                        const Provenance& provenance,
                                                        const std::function<FluidBody()>& build) {
  if (folder_.empty()) return std::make_shared<const FluidBody>(build());
  const fs::path file = folder_ / keptFileName(name, provenance);
  if (std::optional<FluidBody> kept = readIfSame(file, name, provenance))
    return std::make_shared<const FluidBody>(*std::move(kept));
  auto body = std::make_shared<const FluidBody>(build());
  unsaved_.emplace(file, body);
  return body;
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOrBuild(const ShapeDescription& shape,
                                                             const std::string& name,
                                                             int waterline_subdivisions) {
  if (isTabulatedSolid(shape.geometry)) return readOrMakeSolid(shape, name, waterline_subdivisions);
  ShapeBuildSettings settings;
  settings.waterline_subdivisions = waterline_subdivisions;
  settings.name = name;
  settings.flow.threads = threads_;
  const auto build = [&] {
    BuiltBody built = buildShape(shape, settings);
    warnings_.insert(warnings_.end(), built.warnings.begin(), built.warnings.end());
    return std::move(built.body);
  };
  if (std::holds_alternative<FluidBodyFile>(shape.geometry))
    return std::make_shared<const FluidBody>(build());
  return readOr(name, describeShape(shape, settings), build);
}

void SceneBodyCache::save() {
  if (unsaved_.empty()) return;
  fs::create_directories(folder_);
  for (const auto& [file, body] : unsaved_) writeFluidBody(*body, file);
  unsaved_.clear();
}

}  // namespace ambient
