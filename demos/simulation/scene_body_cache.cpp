#include "demos/simulation/scene_body_cache.h"

#include <utility>

#include "preprocess/builder/shape_builder.h"

namespace ambient {
namespace {

/// Whether Fluid::addAll() would find the shape as a collision shape that has a table.
bool isTabulatedSolid(const Shape& shape) {
  return std::holds_alternative<Box>(shape) || std::holds_alternative<Cylinder>(shape) ||
         std::holds_alternative<Capsule>(shape) || std::holds_alternative<Cone>(shape);
}

}  // namespace

SceneBodyCache::SceneBodyCache(BodyFolder folder, int threads, BodyMaker::Report report)
    : maker_(std::move(folder), std::move(report)), threads_(threads) {}

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
                                                        const BodyMaker::Make& make) {
  unsaved_.push_back(maker_.get(name, provenance, make, whose_));
  warn(unsaved_.back().body->provenance.said);
  return unsaved_.back().body;
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOrBuild(const ShapeDescription& shape,
                                                             const std::string& name,
                                                             int waterline_subdivisions) {
  if (isTabulatedSolid(shape.geometry)) return readOrMakeSolid(shape, name, waterline_subdivisions);
  ShapeBuildSettings settings;
  settings.waterline_subdivisions = waterline_subdivisions;
  settings.name = name;
  settings.flow.threads = threads_;
  const auto build = [&](const auto& begin) {
    settings.begin = begin;
    return buildShape(shape, settings).body;
  };
  if (std::holds_alternative<FluidBodyFile>(shape.geometry))
    return std::make_shared<const FluidBody>(buildShape(shape, settings).body);
  return readOr(name, describeShape(shape, settings), build);
}

void SceneBodyCache::save() {
  for (const BodyMaker::Made& made : unsaved_) maker_.keep(made);
  unsaved_.clear();
}

}  // namespace ambient
