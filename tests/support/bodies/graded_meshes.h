#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::test {

/// Regular tetrahedron with corners (1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1), 4 n^2
/// triangles, graded towards its edges.
TriangleMesh gradedTetrahedron(int n);

/// Half a unit ball, z > 0, 12 n^2 triangles; the flat face is graded towards the rim.
TriangleMesh gradedHemisphere(int n);

/// Ring torus about z, tube radius `tube`, 2 around x along triangles.
struct TorusShape {
  double radius = 2, tube = 1;
  int around = 36, along = 36;
};
TriangleMesh makeTorus(const TorusShape& shape);

/// Every cross-section turned about z by `rate` radians per metre.
TriangleMesh twisted(TriangleMesh mesh, double rate);

/// Volume enclosed [m^3].
double volumeOf(const TriangleMesh& mesh);

}  // namespace ambient::test
