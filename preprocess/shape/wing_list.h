#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace ambient {

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
