#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/resistance/surface_flow.h"

namespace ambient {

/// Where smooth layers leave along one way: share of the body's length along the motion, from its
/// front; the mean over the line along which they leave. 1: nowhere.
struct LayerPlaces {
  double laminar = 1, turbulent = 1;
};

/// The numbers of one way, and how much of the base separates, on the area seen along the motion.
struct LayerSums {
  SeparationWay way;
  LayerPlaces leaves_at;
  double base = 0;  ///< area behind laminar separation, projected along the motion [D_A^2]
  double smooth_base =
      0;  ///< of it, that of streamlines that left a smooth surface and crossed no sharp edge
  /// False where a friction came out negative, as velocities at edges and in hollows may that the
  /// mesh does not resolve: it is 0.
  bool is_resolved = true;
};

/// Follows laminar and turbulent layers downstream along the streamlines of a flow. Cost O(V log
/// V).
/// @param flow of the body's motion along the unit vector `motion`, by vertex of the surface
LayerSums followLayers(const CutSurface& surface, const std::vector<VertexFlow>& flow,
                       const Eigen::Vector3d& motion);

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
