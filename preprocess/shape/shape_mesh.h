#pragma once

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

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

/// Makes the mesh of a MeshFile or MeshSheet from its file's mesh, which was imported with the
/// scale of the shape.
/// @pre the shape is a MeshFile or a MeshSheet.
CheckedMesh makeShapeMesh(const ShapeDescription& shape, const ImportedMesh& imported,
                          double scale);

}  // namespace ambient
