#pragma once

#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Sizes of a surface that Reynolds numbers, areas and the twist of separated flow are made of;
/// docs/theory.md eq. (101). Both sides of a sheet count.
struct SurfaceNumbers {
  double diameter = 0;       ///< D_A = sqrt(area/pi): of the ball with this area [m]
  Vector3 frontal{0, 0, 0};  ///< A_j: half of the projected area of all faces along q_j [m^2]
  Vector3 moments{0, 0, 0};  ///< m_j: mean square of the place along q_j [m^2]
  Matrix3 gyration =
      Matrix3::Zero();  ///< G: mean of |r|^2 I - r r^T about the centre of reaction [m^2]
};

/// Centres of a body in the frame of its mesh [m].
struct BodyCentres {
  Vector3 volume{0, 0, 0}, reaction{0, 0, 0};
};

/// Computes the sizes of a surface, exact integrals over its triangles. Cost O(T).
/// @param axes columns q_j
/// @pre the mesh has an area
SurfaceNumbers computeSurfaceNumbers(const TriangleMesh& mesh, bool sheet,
                                     const BodyCentres& centres, const Matrix3& axes);

/// Returns eps' in [0, 1], how far edges and thin plates fix where the flow leaves: eps + W (1 -
/// eps) with eps of eq. (51d), W of (45a). 0 of a ball, 1 of a box or plate.
double sharpShare(const FormShape& shape);

}  // namespace ambient
