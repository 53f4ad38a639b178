#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "preprocess/shape/shapes.h"

namespace ambient {

/// Reads a shape from parsed JSON, validated by the schema first. Relative file names in it are
/// relative to `directory`; the files are not opened. `source` begins every message.
/// @throws std::runtime_error in one line that names the key, the value and the limit.
ShapeDescription readShape(const nlohmann::json& shape, const std::filesystem::path& directory,
                           const std::string& source);

/// Reads a JSON file that holds one shape.
/// @throws std::runtime_error in one line that names the file.
ShapeDescription readShapeFile(const std::filesystem::path& file);

}  // namespace ambient
