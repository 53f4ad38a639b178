#include "demos/scene/scene_parts.h"
#include "demos/simulation/robots/robots_in_world.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {

std::unique_ptr<RobotsInWorld> makeRobotsInWorld() { return nullptr; }

PreparedBody prepareLink(const Scene& scene, const BodyDef& def, SceneBodyCache&) {
  raiseInputError(scene.file.string(), "body \"", def.name, "\" ", kNeedsWholeDemo);
}

std::shared_ptr<const FluidBody> SceneBodyCache::readOrMakeSolid(const ShapeDescription& shape,
                                                                 const std::string&, int) {
  raiseInputError(shape.source, "a box, cylinder, capsule or cone ", kNeedsWholeDemo);
}

}  // namespace ambient
