#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// What panels are cut from: the same surface to 1e-7 of its size. refineSurface() divides the
/// triangles it is given, and cannot make good panels of strips, nor of more triangles than it may
/// have. A shape of sharp edges and corners between flat sides is described by a few large
/// triangles, Delaunay triangles between its corners, however its sides were cut; of others, flat
/// triangles more than 50 times as long as high are merged with their neighbours. The mesh itself
/// if it has neither, if its triangles stand for parts of a smooth surface (estimateBulges()), or
/// if none shall be divided. Vertices keep their numbers; not all are used. Cost O(T log T).
/// @param max_panels as PotentialFlowSettings::max_panels
/// @pre the mesh passed checkMesh().
TriangleMesh mergeFlatTriangles(const TriangleMesh& mesh, bool sheet, int max_panels);

}  // namespace ambient
