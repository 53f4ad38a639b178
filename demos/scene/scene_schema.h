#pragma once

#include "preprocess/shape/json_schema.h"

namespace ambient {

/// data/schema/scene.schema.json as it was when the program was built.
const JsonSchema& sceneSchema();

}  // namespace ambient
