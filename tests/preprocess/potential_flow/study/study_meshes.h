#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {

/// Regular solids of few triangles, centred at the origin. The solids, not the meshes, are
/// symmetric under x -> -x, y -> -y, z -> -z.
TriangleMesh makeOctahedron();
TriangleMesh makeIcosahedron();
/// Three triangles per pentagon.
TriangleMesh makeDodecahedron();
/// Five triangles per pentagon, about its centre.
TriangleMesh makeCentredDodecahedron();

/// Divides each triangle into n^2, with quadratic grading towards its edges: for solids with all
/// edges of triangles sharp.
TriangleMesh gradedTowardsEdges(const TriangleMesh& coarse, int n);

/// Half a spherical shell about the origin, z < 0, outer radius 1 [m].
struct BowlMesh {
  double thickness = 0.1;  ///< below 1 [m]
  int rings = 10;          ///< per dome, with 6 n^2 triangles
  int rim_rows = 1;        ///< across the flat rim
  bool graded = false;     ///< true: graded towards the rim's edges
};
TriangleMesh makeBowl(const BowlMesh& bowl);
/// Volume of the smooth bowl [m^3].
double bowlVolume(double thickness);

/// Scales a mesh about the origin to this volume.
TriangleMesh scaledToVolume(TriangleMesh mesh, double volume);

}  // namespace ambient::study
