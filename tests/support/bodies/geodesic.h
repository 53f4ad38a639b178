#pragma once

#include <map>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient::test {

/// A closed triangle mesh: corners counter-clockwise from outside.
struct Triangulation {
  std::vector<Vector3> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

/// Unit sphere of 20 * 4^level triangles: an icosahedron, its edges bisected `level` times. Made
/// with
/// +, -, *, / and the square root only, so that its bits do not depend on the machine.
Triangulation geodesicSphere(int level);

/// geodesicSphere(), turned, then stretched to an ellipsoid with semi-axes [m] along x, y, z. Each
/// turn gives a different triangulation of one body.
Triangulation geodesicEllipsoid(const Vector3& semi_axes, int level,
                                const Matrix3& turn = Matrix3::Identity());

/// Faces of the flat triangles: their own normals, barycentres and areas.
FaceTable faceTableOf(const Triangulation& mesh);

/// Area of all faces [m^2].
double totalArea(const FaceTable& faces);

/// sqrt(area) [m], the length in the Reynolds number.
double referenceLength(const FaceTable& faces);

}  // namespace ambient::test
