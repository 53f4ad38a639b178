#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Added mass of a shape, known without solving the flow.
struct KnownAddedMass {
  Matrix6 added_mass;  ///< per unit density, about the shape's origin
  bool is_tabulated;   ///< true: from a table; false: closed form
  std::string source;  ///< "closed form", or which tables
};

/// Everything that follows from the numbers of a simple shape. Empty for shapes of files, hulls and
/// triangle soups.
struct ShapeFacts {
  /// Half of the sizes of the bounding box along its axes [m]; of a sheet two.
  Eigen::VectorXd half_extents = {};
  /// Makes a mesh of at most `faces` triangles, with the volume (for a sheet the area) of the
  /// smooth body. @throws std::runtime_error, if they are fewer than least_faces()
  std::function<TriangleMesh(int faces)> mesh = nullptr;
  std::function<int()> least_faces = [] { return 20; };
  /// Returns the added mass of the shape with all lengths times `scale`; none outside the range of
  /// the tables. Cost: microseconds.
  std::function<std::optional<KnownAddedMass>(double scale)> added_mass = [](double) {
    return std::nullopt;
  };
  /// What is known of a shape of known added mass, with all lengths times `scale`, in a fluid with
  /// viscosity. Cost: microseconds.
  std::function<KnownViscousFlow(double scale, const Matrix6& added_mass)> viscous_flow =
      [](double, const Matrix6&) { return KnownViscousFlow{}; };
  bool is_smooth = false;  ///< true: the shape has no edges; errors of its meshes shrink evenly as
                           ///< these get finer
  double sphere_radius = 0;  ///< [m]; 0: no sphere
};

ShapeFacts factsOf(const Shape& shape);

/// Checks the sizes of a shape before anything is computed of them: each extent, times `scale`,
/// must be kSmallestSize to kLargestSize, and the longest at most 1e6 times the shortest. Shapes
/// without facts pass: requireUsualSize() looks at their meshes.
/// @throws std::runtime_error in one line that begins with `source`.
void requireUsualExtents(const Shape& shape, double scale, const std::string& source);

/// True if the shape is an open surface of zero thickness.
bool isSheet(const ShapeDescription& shape);

/// Returns the file with the mesh or fluid body of a shape; empty for other shapes.
std::filesystem::path fileOf(const ShapeDescription& shape);

/// Makes the triangles of a shape in its frame S. Meshes are read from their files and checked;
/// other shapes are generated. Round shapes get the volume of the smooth body (elliptic sheets: the
/// area), not vertices on its surface: a ball of 1280 triangles would otherwise have 1 % too little
/// volume and added mass. A mesh that is not a closed body is wrapped, see makeBodyMesh(). All
/// lengths are multiplied by `scale`. Warns of a mesh file whose size suggests another
/// unit than the metre.
/// @pre the shape is not a FluidBodyFile; the scale is positive and finite
/// @throws std::runtime_error in one line that begins with the shape's source.
CheckedMesh makeShapeMesh(const ShapeDescription& shape, double scale = 1);

/// Makes the mesh of a MeshFile from its file's mesh, which was imported with the scale of the
/// shape.
/// @pre the shape is a MeshFile.
CheckedMesh makeShapeMesh(const ShapeDescription& shape, const ImportedMesh& imported,
                          double scale);

}  // namespace ambient
