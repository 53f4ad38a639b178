#pragma once

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

}  // namespace ambient
