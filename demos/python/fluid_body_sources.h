#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"

namespace ambient {

/// Where fluid bodies are kept between programs, and how one is made.
struct SourceSettings {
  std::string name;
  std::optional<Eigen::Vector3d>
      origin;  ///< of F in the mesh's frame [m]; none: the centre of volume
  int panels = kDefaultPanels;
  int threads = 0;
  int waterline_subdivisions = 0;  ///< as in BuildSettings
  std::filesystem::path cache;     ///< a folder; empty: none
};

/// A fluid body of a mesh in memory. @throws std::runtime_error in one line that begins with the
/// name.
BuiltBody buildFromMesh(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings);

/// A fluid body of a shape in JSON, see shape.schema.json; relative files in it are relative to
/// `folder`. @throws std::runtime_error as buildShape().
BuiltBody buildFromShape(const std::string& json, const std::filesystem::path& folder,
                         const SourceSettings& settings);

}  // namespace ambient
