#include "preprocess/mesh/import/mesh_import.h"

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "preprocess/mesh/import/scene_triangles.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

// Single precision relative to the origin, as the file gives it, may be coarse relative to the
// body. Refuses what would be a staircase.
std::string resolutionWarning(const TriangleMesh& mesh, double diagonal, const std::string& name) {
  constexpr double kCoarse = 1e-4, kTooCoarse = 0.01;
  const double farthest = mesh.vertices.cwiseAbs().maxCoeff();
  const double resolution = std::numeric_limits<float>::epsilon() * farthest / diagonal;
  if (resolution < kCoarse) return {};
  std::ostringstream warning;
  warning.precision(3);
  warning << "lies " << farthest / diagonal << " times its size from the origin, where single "
          << "precision resolves only " << resolution << " of its size: move it to the origin";
  if (resolution > kTooCoarse) raiseInputError(name, warning.str());
  return name + ": " + warning.str();
}

void weld(ImportedMesh& imported, const std::string& name) {
  TriangleMesh& mesh = imported.mesh;
  const double diagonal = mesh.extents().norm();
  const std::string warning = resolutionWarning(mesh, diagonal, name);
  if (!warning.empty()) imported.warnings.push_back(warning);
  const Eigen::Index before = mesh.triangleCount();
  mesh = weldVertices(mesh, kWeldTolerance * diagonal);
  if (mesh.triangleCount() == before) return;
  std::ostringstream text;
  text << name << ": " << before - mesh.triangleCount() << " of " << before
       << " triangles are shorter than " << kWeldTolerance << " of its size and were left out";
  imported.warnings.push_back(text.str());
}

// Reads a file that has triangles.
SceneTriangles readTriangles(const std::filesystem::path& file) {
  const std::string name = file.string();
  requireRegularFile(file, "mesh");
  if (std::filesystem::file_size(file) == 0) raiseInputError(name, "the file is empty");
  SceneTriangles scene = readSceneTriangles(file);
  if (scene.mesh.triangleCount() == 0) raiseInputError(name, "there are no triangles");
  return scene;
}

}  // namespace

ImportedMesh importMesh(const std::filesystem::path& file, double scale) {
  const std::string name = file.string();
  if (!std::isfinite(scale) || scale <= 0) {
    raiseInputError(name, "scale = ", scale, " is not positive and finite");
  }
  SceneTriangles scene = readTriangles(file);
  ImportedMesh imported{std::move(scene.mesh), {}};
  if (!scene.warning.empty()) imported.warnings.push_back(name + ": " + scene.warning);
  if (scene.points_and_lines > 0) {
    imported.warnings.push_back(name + ": " + std::to_string(scene.points_and_lines) +
                                " points and lines were left out");
  }
  // Vertices that are not finite cannot be welded; checkMesh() names them later.
  if (imported.mesh.vertices.allFinite()) weld(imported, name);
  imported.mesh.vertices *= scale;
  if (imported.mesh.triangleCount() == 0)
    raiseInputError(name, "all triangles are points or lines");
  return imported;
}

std::vector<TriangleMesh> importObjects(const std::filesystem::path& file) {
  const SceneTriangles scene = readTriangles(file);
  const std::string ending = file.extension().string();
  const bool has_objects = ending == ".obj" || ending == ".OBJ";
  std::map<std::string, std::size_t> places;  // a name has several nodes if its materials change
  std::vector<std::vector<Eigen::Vector3i>> triangles;
  for (Eigen::Index t = 0; t < scene.mesh.triangleCount(); ++t) {
    const int node = has_objects ? scene.nodes[static_cast<std::size_t>(t)] : -1;
    const std::string name = node < 0 ? "" : scene.names[static_cast<std::size_t>(node)];
    const auto [place, is_new] = places.try_emplace(name, triangles.size());
    if (is_new) triangles.emplace_back();
    triangles[place->second].push_back(scene.mesh.triangles.col(t));
  }
  std::vector<TriangleMesh> objects;
  for (const auto& of_object : triangles)
    objects.push_back(withUsedVertices(scene.mesh.vertices, of_object));
  return objects;
}

}  // namespace ambient
