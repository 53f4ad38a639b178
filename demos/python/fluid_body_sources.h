#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"

namespace ambient {

/// Settings of building a fluid body, and the folder in which fluid bodies are kept.
struct SourceSettings {
  std::string name;
  std::optional<Eigen::Vector3d>
      origin;  ///< origin of F in the mesh's frame [m]; none: centre of volume
  int panels = kDefaultPanels;
  int threads = 0;
  int waterline_subdivisions = 0;  ///< see BuildSettings
  std::filesystem::path cache;     ///< folder of .ambient files; empty: no cache
};

/// Builds a fluid body of a mesh in memory; `sheet`: the mesh is a sheet of zero thickness.
/// @throws std::runtime_error in one line that begins with settings.name
BuiltBody buildFromMesh(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings);

/// Builds a fluid body of a shape in JSON, see shape.schema.json. Relative paths of files are
/// relative to `folder`. @throws std::runtime_error as buildShape().
BuiltBody buildFromShape(const std::string& json, const std::filesystem::path& folder,
                         const SourceSettings& settings);

}  // namespace ambient
