#pragma once

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Whether the shape is an open surface of zero thickness.
bool isSheet(const ShapeDescription& shape);

/// The file with the shape's mesh or fluid body; empty for the others.
std::filesystem::path fileOf(const ShapeDescription& shape);

/// The triangles of a shape in its frame S. Meshes are read and checked; the others are made, round
/// ones with the volume of the smooth body (elliptic sheets: the area) instead of vertices on its
/// surface: a ball of 1280 triangles would displace 1 % too little, and carry so much less added
/// mass.
/// Where a mesh is refused as a body that wrapSurface() would make one of, the message says so.
/// All lengths are multiplied by `scale`; a file whose mesh is then of a size that another unit
/// than the metre would explain is warned of.
/// @pre the shape is not a FluidBodyFile; the scale is positive and finite
/// @throws std::runtime_error in one line that begins with the shape's source.
CheckedMesh makeShapeMesh(const ShapeDescription& shape, double scale = 1);

/// Makes the mesh of a MeshFile or MeshSheet from its file's mesh, which was imported with the
/// scale of the shape.
/// @pre the shape is a MeshFile or a MeshSheet.
CheckedMesh makeShapeMesh(const ShapeDescription& shape, const ImportedMesh& imported,
                          double scale);

}  // namespace ambient
