#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Merges flat triangles, so that refineSurface() can cut good panels: that only divides triangles,
/// and can repair neither narrow strips nor too many triangles. The surface stays the same to 1e-7
/// of its size.
/// A shape with sharp edges and corners between flat sides becomes the few large Delaunay triangles
/// between its corners, however its sides were cut. On other shapes, flat triangles more than 50
/// times as long as high are merged with their neighbours. Returns the mesh itself if it has
/// neither, if its triangles approximate parts of a smooth surface (estimateBulges()), or if
/// max_panels is 0. Vertices keep their numbers; not all are used. Cost O(T log T).
/// @param max_panels as PotentialFlowSettings::max_panels
/// @pre the mesh passed checkMesh().
TriangleMesh mergeFlatTriangles(const TriangleMesh& mesh, bool sheet, int max_panels);

/// Merges the flat triangles of a polyhedron to the few large Delaunay triangles between its
/// corners, whatever the angles between its sides. Otherwise as mergeFlatTriangles().
TriangleMesh mergePolyhedronSides(const TriangleMesh& mesh);

}  // namespace ambient
