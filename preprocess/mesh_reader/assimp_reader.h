#pragma once

#include <string>

#include "preprocess/mesh_reader/polygon_collector.h"

namespace ambient {

/// Polygons of a scene, placed by its nodes, once per node, and a warning line if the reader of the
/// format has turned the axes.
struct AssimpScene {
  PolygonCollector polygons;
  std::string warning;
};

/// Reads a file with assimp, the axes as they are in the file where that can be asked for.
/// @throws std::runtime_error with one sentence that does not name the file.
AssimpScene readWithAssimp(const std::string& file);

}  // namespace ambient
