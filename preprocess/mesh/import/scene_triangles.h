#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The triangles of a mesh file in its own frame, with one vertex list per mesh and node.
struct SceneTriangles {
  TriangleMesh mesh;
  std::int64_t points_and_lines = 0;  ///< number of points and lines that were left out
  std::string warning;                ///< for the user, without the file's name; mostly empty
};

/// Exit code of ambient_mesh_reader if it refuses the file; it has then written why.
constexpr int kRefusedByReader = 3;

/// Reads a file with the program ambient_mesh_reader, so that crashes, damaged memory and endless
/// loops of its readers end with that program; polygons are divided into triangles. It may take
/// 10 s of processor time, and 2 s for each megabyte. It writes three numbers of 64 bits: points
/// and lines, vertices, triangles; then the coordinates as doubles, the corners as ints, and the
/// warning.
/// @throws std::runtime_error in one line that begins with the file.
SceneTriangles readSceneTriangles(const std::filesystem::path& file);

}  // namespace ambient
