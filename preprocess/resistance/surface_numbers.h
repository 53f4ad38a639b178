#pragma once

#include "bullet_ambient/fluid_body/viscous_form.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

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
