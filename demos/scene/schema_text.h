#pragma once

namespace ambient {

/// The text of data/schema/scene.schema.json, generated when the project is built.
extern const char* const kSceneSchemaText;

}  // namespace ambient
