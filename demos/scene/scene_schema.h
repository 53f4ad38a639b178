#pragma once

#include "preprocess/shape/json_schema.h"

namespace ambient {

/// Content of data/schema/scene.schema.json, compiled into the program.
const JsonSchema& sceneSchema();

}  // namespace ambient
