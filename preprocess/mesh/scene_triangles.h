#pragma once

#include <cstdint>
#include <filesystem>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The triangles of a mesh file in its own frame, with one vertex list per mesh and node.
struct SceneTriangles {
  TriangleMesh mesh;
  std::uint64_t points_and_lines = 0;  ///< that were left out
};

/// Reads a file with assimp, in a child process: damaged files make some of its readers crash or
/// run for ever (assimp 5.2: OFF files with wrong numbers of corners, PLY files with a torn
/// header). Polygons are divided into triangles. The child may take 10 s of processor time, and 2 s
/// for each megabyte.
/// @throws std::runtime_error in one line that begins with the file.
SceneTriangles readSceneTriangles(const std::filesystem::path& file);

}  // namespace ambient
