#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

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

/// Wing that a JSON file lists: by one of node, box and triangles.
struct ListedWing {
  std::string node;                    ///< name; a * at its end stands for any rest
  Eigen::AlignedBox3d box;             ///< around the middles of its triangles; empty: none
  std::vector<std::size_t> triangles;  ///< of the mesh file, from 0 on
  std::string name;                    ///< that of the node if none is given
  std::optional<double> span, chord;   ///< in the mesh's units
  std::optional<double> aspect;
};

/// Content of the file, docs/wings.md.
struct WingList {
  std::vector<ListedWing> wings;
  bool wants_rest = false;  ///< whether others are looked for, too
};

/// @throws std::runtime_error in one line that names the file, if it cannot be read or is none.
WingList readWingList(const std::string& file);

}  // namespace ambient
