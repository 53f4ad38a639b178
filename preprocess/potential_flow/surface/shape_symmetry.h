#pragma once

#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Mirrors and half turns about the centre that map the solid to itself, whichever way its flat
/// faces are cut into triangles: every edge that bends goes to one with the same faces, to 1e-7 of
/// the size. Looked for along the axes of the mesh and the principal axes of its vertices. Cost
/// O(T log T).
std::vector<Eigen::Matrix3d> findSymmetries(const TriangleMesh& mesh,
                                            const Eigen::Vector3d& centre);

/// The inertia of the body mapped by a mirror or a turn about the origin, rotation first.
Matrix6 turned(const Matrix6& inertia, const Eigen::Matrix3d& turn);

/// The inertia about that centre, rotation first, without what the symmetries forbid: the mean over
/// each of them and none.
Matrix6 symmetrised(Matrix6 inertia, const std::vector<Eigen::Matrix3d>& symmetries);

/// The added mass about the mesh's origin, which somebody has extrapolated or found on another mesh
/// of the body, without what the symmetries of this one forbid.
Matrix6 symmetrisedAddedMass(const Matrix6& added_mass, const TriangleMesh& mesh);

}  // namespace ambient
