#pragma once

#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Finds mirrors and half turns about the centre that map a solid to itself, however its flat faces
/// are cut into triangles: every edge at which the surface bends must land on such an edge, with
/// the normals of its faces, to 1e-7 of the size. Tests the axes of the mesh and the principal axes
/// of its vertices. Cost O(T log T).
std::vector<Eigen::Matrix3d> findSymmetries(const TriangleMesh& mesh,
                                            const Eigen::Vector3d& centre);

/// Returns the inertia of the body after a mirror or turn about the origin, rotation first.
Matrix6 turned(const Matrix6& inertia, const Eigen::Matrix3d& turn);

/// Returns an inertia about the centre, rotation first, without entries that the symmetries forbid:
/// for each symmetry, the mean of the inertia and its image.
Matrix6 symmetrised(Matrix6 inertia, const std::vector<Eigen::Matrix3d>& symmetries);

/// How a 6x6 matrix changes when all lengths are multiplied by a factor.
using Rescaling = Matrix6 (*)(const Matrix6& matrix, double factor);

/// Returns an inertia or a resistance about the mesh's origin as the nearest positive semi-definite
/// one without entries that the symmetries of the mesh forbid, stretched about its centre.
Matrix6 withSymmetriesOf(const TriangleMesh& mesh, bool sheet, const Matrix6& matrix,
                         Rescaling rescaled, double stretch = 1);

/// Returns an added mass about the mesh's origin without entries that the symmetries of the mesh
/// forbid; for values that were extrapolated or found on another mesh of the body.
Matrix6 symmetrisedAddedMass(const Matrix6& added_mass, const TriangleMesh& mesh);

}  // namespace ambient
