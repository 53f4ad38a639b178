#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/body_folder.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"

namespace ambient {

/// Settings for building a fluid body in Python.
struct SourceSettings : CommonBuildSettings {
  BodyFolder cache;     ///< default: none
  bool strict = false;  ///< refuse a mesh that is not a closed body, in place of wrapping it
};

/// Builds a fluid body of a mesh in memory; `sheet`: the mesh is a sheet of zero thickness.
/// @throws std::runtime_error in one line that begins with settings.name
BuiltBody buildFromMesh(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings);

/// Builds a fluid body of a shape in JSON, see shape.schema.json. Relative paths of files are
/// relative to `folder`. @throws std::runtime_error as buildShape().
BuiltBody buildFromShape(const std::string& json, const std::filesystem::path& folder,
                         const SourceSettings& settings);

}  // namespace ambient
