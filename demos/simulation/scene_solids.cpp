#include <optional>

#include "demos/simulation/scene_body_cache.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/collision_shape/form_body.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {

CollisionShapeSettings SceneBodyCache::solidSettings(const std::string& name) {
  CollisionShapeSettings settings;
  settings.name = name;
  settings.flow.threads = threads_;
  settings.report = nullptr;  // readOr() warns
  return settings;
}

std::shared_ptr<const FluidBody> SceneBodyCache::get(const btCollisionShape& shape,
                                                     const std::string& name) {
  CollisionShapeSettings settings = solidSettings(name);
  const Provenance from = describeCollisionShape(shape, settings);
  const std::string key =
      from.source + " " + std::to_string(from.source_hash) + " " + from.settings;
  std::shared_ptr<const FluidBody>& known = by_text_[key];
  const auto make = [&](const auto& begin) {
    settings.begin = begin;
    return makeFluidBody(shape, settings);
  };
  if (!known) known = readOr(name, from, make);
  return known;
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOrMakeSolid(const ShapeDescription& shape,
                                                                 const std::string& name,
                                                                 int waterline_subdivisions) {
  requireUsualExtents(shape.geometry, 1, shape.source);
  CollisionShapeSettings settings = solidSettings(name);
  settings.faces = shape.faces;
  settings.waterline_subdivisions = waterline_subdivisions;
  const ShapeForm form{shape.text, {{shape.geometry, RigidPose::Identity(), name}}, 1};
  const auto make = [&](const auto&) { return makeFormBody(form, settings); };
  return readOr(name, describeForm(form, settings), make);
}

}  // namespace ambient
