#pragma once

namespace ambient {

/// The text of data/schema/shape.schema.json, generated when the project is built.
extern const char* const kShapeSchemaFile;

}  // namespace ambient
