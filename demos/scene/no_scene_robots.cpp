#include "demos/scene/scene_parts.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {

void addRobot(const nlohmann::json&, Scene& scene) {
  raiseInputError(scene.file.string(), "a robot ", kNeedsWholeDemo);
}

}  // namespace ambient
