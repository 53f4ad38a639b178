#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Distance up to which vertices of a file are joined, over the diagonal of the bounding box [1].
constexpr double kWeldTolerance = 1e-6;

/// A mesh as in its file, and warnings for the user, one line each.
struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
};

/// Reads the triangles of a mesh file: OBJ, STL, PLY, glTF, OFF and whatever else assimp reads. All
/// meshes of the scene count, each as often and where its nodes place it; polygons are divided into
/// triangles, points and lines left out. Axes are those of the file, or a warning says how its
/// format's reader has turned them. Vertices closer than kWeldTolerance are welded, across
/// meshes too, and triangles that vanish by it dropped. Coordinates are in single precision in
/// assimp, whatever the file holds, and are multiplied by `scale` in double. Nothing is checked
/// beyond that: see checkMesh().
/// @throws std::runtime_error in one line that names the file, if it is missing, not a mesh or has
/// no triangles, or if the scale is not positive and finite.
ImportedMesh importMesh(const std::filesystem::path& file, double scale = 1);

/// Reads the objects of an OBJ file, which begin with its lines `o` and `g`, in their order, each
/// with the vertices that it uses: parts of a convex decomposition, say. Any other file is one.
/// @throws as importMesh()
std::vector<TriangleMesh> importObjects(const std::filesystem::path& file);

/// Exit status and output of a child process.
struct ChildResult {
  int exit_code = 0;
  int signal = 0;      ///< signal that ended the process; 0: none
  std::string output;  ///< standard output
};

/// Runs a program of this project, without a shell: `command` is its name and its arguments. The
/// program is taken from the folder of the running one, where the build and the installation put
/// both, else from the PATH. May be called from any thread.
/// @throws std::runtime_error if it cannot be started, with the reason.
ChildResult runChild(const std::vector<std::string>& command);

/// The triangles of a mesh file in its own frame, with one vertex list per mesh and node.
struct SceneTriangles {
  TriangleMesh mesh;
  std::int64_t points_and_lines = 0;  ///< number of points and lines that were left out
  std::string warning;                ///< for the user, without the file's name; mostly empty
  std::vector<int> nodes;             ///< index into `names` of each triangle; -1: none
  std::vector<std::string> names;     ///< of nodes and groups; may be empty or the same
};

/// Exit code of ambient_mesh_reader if it refuses the file; it has then written why.
constexpr int kRefusedByReader = 3;

/// Reads a file with the program ambient_mesh_reader, so that crashes, damaged memory and endless
/// loops of its readers end with that program; polygons are divided into triangles. It may take
/// 10 s of processor time, and 2 s for each megabyte. It writes three numbers of 64 bits: points
/// and lines, vertices, triangles; then the coordinates as doubles, the corners and the nodes of
/// the triangles as ints, the warning, and the names of the nodes, a line each.
/// @throws std::runtime_error in one line that begins with the file.
SceneTriangles readSceneTriangles(const std::filesystem::path& file);

}  // namespace ambient
