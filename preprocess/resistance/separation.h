#pragma once

#include <Eigen/Core>
#include <array>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/resistance/boundary_layers.h"

namespace ambient {

/// Axes q_j of the added mass: eigenvectors of its translation block about the centre of volume, in
/// ascending order of its eigenvalues; the largest component of the first two is positive, and they
/// are right-handed.
Matrix3 translationAxes(const Matrix6& added_mass);

/// The numbers of a mesh.
struct MeshSeparation {
  Separation separation;
  std::array<LayerPlaces, 6> leaves_at;  ///< by way, as in Separation::ways
  /// False where the mesh does not resolve the flow along an axis whose base is in part smooth:
  /// LayerSums::is_resolved.
  bool is_resolved = true;
};

/// Computes the numbers of a closed mesh whose flow was solved. On 2000 triangles of a smooth body
/// k_L and k_4, N and f_L are within 3 %, k_B and k_1 within 10 %, f_B within 12 %, f_T within 1 %
/// of those of the body. Cost: 2000 triangles take 20 ms of one core.
/// @param potential V x 3 [m], for unit velocities along the axes of the mesh: the right half of
/// PotentialFlow::potential
/// @pre closed and manifold
MeshSeparation computeSeparation(const TriangleMesh& mesh,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& potential,
                                 const Matrix3& axes);

/// Computes the numbers of an ellipsoid, with its flow in closed form on a mesh of `faces`
/// triangles.
/// @pre semi-axes positive and finite [m]
Separation ellipsoidSeparation(const Vector3& semi_axes, int faces = 2000);

/// The numbers of a ball, of any axes: Thwaites' and Buri's integrals over the meridian.
Separation sphereSeparation();

/// The numbers of a cylinder about z, radius and height [m]: across, those of the plane flow past a
/// circle; along, the rims make all of the base. B_j across is the share of the side in the
/// surface.
/// @param axes translationAxes(): each along z or across
Separation cylinderSeparation(double radius, double height, const Matrix3& axes);

}  // namespace ambient
