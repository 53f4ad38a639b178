#include "demos/simulation/scene_body_cache.h"

#include <cstdio>
#include <stdexcept>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "bullet_ambient/fluid_body/fnv1a.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/shape/json_text.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

/// Differs between two builds of this program.
std::string programStamp() {
  const fs::path program = "/proc/self/exe";
  std::error_code error;
  const auto size = fs::file_size(program, error);
  const auto time = fs::last_write_time(program, error).time_since_epoch().count();
  return std::to_string(size) + " " + std::to_string(time);
}

}  // namespace

SceneBodyCache::SceneBodyCache(fs::path folder, int threads)
    : folder_(std::move(folder)), threads_(threads) {}

std::shared_ptr<const FluidBody> SceneBodyCache::get(const ShapeDescription& shape,
                                                     const std::string& name) {
  std::shared_ptr<const FluidBody>& known = by_text_[shape.text];
  if (!known) known = readOrBuild(shape, name);
  return known;
}

std::shared_ptr<const FluidBody> SceneBodyCache::get(const btCollisionShape& shape,
                                                     const std::string& name) {
  CollisionShapeSettings settings;
  settings.name = name;
  settings.flow.threads = threads_;
  settings.tables = false;
  settings.report = [this](const std::string& line) { warnings_.push_back(line); };
  const Provenance from = describeCollisionShape(shape, settings);
  const std::string key =
      from.source + " " + std::to_string(from.source_hash) + " " + from.settings;
  std::shared_ptr<const FluidBody>& known = by_text_[key];
  if (!known) known = readOr(key, [&] { return solveOrGuess(shape, settings); });
  return known;
}

FluidBody SceneBodyCache::solveOrGuess(const btCollisionShape& shape,
                                       CollisionShapeSettings settings) {
  try {
    return makeFluidBody(shape, settings);
  } catch (const std::runtime_error& error) {
    settings.quality = Quality::kInstant;
    FluidBody guess = makeFluidBody(shape, settings);
    warnings_.push_back(std::string(error.what()) +
                        "; its added mass is that of an ellipsoid of its size");
    return guess;
  }
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOr(const std::string& key,
                                                        const std::function<FluidBody()>& build) {
  if (folder_.empty()) return std::make_shared<const FluidBody>(build());
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(fnv1a64(programStamp() + "\n" + key)));
  const fs::path file = folder_ / (std::string(hash) + ".ambient");
  if (fs::exists(file)) {
    try {
      return std::make_shared<const FluidBody>(readFluidBody(file));
    } catch (const std::runtime_error&) {
      // A damaged file is as good as none: save() replaces it.
    }
  }
  auto body = std::make_shared<const FluidBody>(build());
  unsaved_.emplace(file, body);
  return body;
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOrBuild(const ShapeDescription& shape,
                                                             const std::string& name) {
  const auto build = [&] {
    ShapeBuildSettings settings;
    settings.name = name;
    settings.flow.threads = threads_;
    settings.tables = false;  // scenes are published: new tables should not change their bits
    BuiltBody built = buildShape(shape, settings);
    warnings_.insert(warnings_.end(), built.warnings.begin(), built.warnings.end());
    return std::move(built.body);
  };
  if (std::holds_alternative<FluidBodyShape>(shape.geometry))
    return std::make_shared<const FluidBody>(build());
  const fs::path mesh = fileOf(shape);
  return readOr(shape.text + "\n" + (mesh.empty() ? "" : readBytes(mesh)), build);
}

void SceneBodyCache::save() {
  if (unsaved_.empty()) return;
  fs::create_directories(folder_);
  for (const auto& [file, body] : unsaved_) writeFluidBody(*body, file);
  unsaved_.clear();
}

}  // namespace ambient
