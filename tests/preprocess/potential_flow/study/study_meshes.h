#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {

/// Regular solids with few triangles, centred at the origin, symmetric under x -> -x, y -> -y,
/// z -> -z (as solids, not as meshes).
TriangleMesh makeOctahedron();
TriangleMesh makeIcosahedron();
/// Three triangles per pentagon.
TriangleMesh makeDodecahedron();
/// Five triangles per pentagon, about its centre.
TriangleMesh makeCentredDodecahedron();

/// Every triangle divided into n^2, thinned quadratically towards its edges: for solids whose
/// triangles are bounded by sharp edges.
TriangleMesh gradedTowardsEdges(const TriangleMesh& coarse, int n);

/// Half a spherical shell about the origin, z < 0, outer radius 1 [m].
struct BowlMesh {
  double thickness = 0.1;  ///< below 1 [m]
  int rings = 10;          ///< of each dome, with 6 n^2 triangles
  int rim_rows = 1;        ///< across the flat rim
  bool graded = false;     ///< thinned towards the rim's edges
};
TriangleMesh makeBowl(const BowlMesh& bowl);
/// Of the smooth bowl [m^3].
double bowlVolume(double thickness);

/// Scaled about the origin to enclose that volume.
TriangleMesh withVolume(TriangleMesh mesh, double volume);

}  // namespace ambient::study
