#pragma once

#include <Eigen/Core>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/panel.h"

namespace ambient {

/// Assembles the matrix of the Stokes equation (93) with one force per area on each group of
/// panels, tested by the same groups: 3 G x 3 G, symmetric [length^3]. One panel of a pair is
/// integrated in closed form, the other over sixteen points if they touch, six if they are nearer
/// than eight times the sum of their radii, else one; with several panels a group three times, and
/// one for all of a farther group. The mean of both orders. The bits do not depend on threads. 300
/// panels take 0.05 s of one core.
/// @param group number of the group of each panel, 0 <= group < count; none is empty
Eigen::MatrixXd assembleStokesMatrix(const std::vector<Panel>& panels,
                                     const std::vector<int>& group, int count, int threads);

// The resistance R of a shape in creeping flow: 6x6, rotation first, per unit viscosity. As Re -> 0
// the wrench about the origin is (torque, force) = -mu R (w, v). Symmetric, positive semi-definite.
// Blocks in m^3, m^2, m. It changes its origin and its axes as an inertia does: shiftOrigin(),
// rotateAxes().

/// Settings of the boundary elements.
struct StokesSettings {
  bool sheet = false;  ///< the mesh is an open surface of zero thickness
  int panels =
      300;  ///< number of panels, or of groups of panels, aimed at; the cost goes with its cube
  int threads = 0;  ///< 0: all cores; the result does not depend on it, bit for bit
};

/// Computes R about the mesh's origin by boundary elements, docs/theory.md eq. (92) to (94), on
/// panels made of the mesh: the faces of a body with edges are cut into smaller ones towards them,
/// twice, and R is extrapolated from both; the triangles of a fine mesh are made fewer; many panels
/// of a sheet are joined to groups alike in normal and place. Entries that the symmetries of the
/// mesh forbid are removed. Errors: 0.2 % of smooth bodies, 0.5 % of bodies with edges, of sheets 1
/// % in translation and 3 % in rotation. Cost: 0.1 s of one core; 0.5 s for a sheet of 4000
/// triangles.
/// @pre the mesh passed checkMesh() as a body or as a sheet.
/// @throws std::runtime_error for no triangles, a triangle without area, or a system that cannot be
/// solved.
Matrix6 computeStokesResistance(const TriangleMesh& mesh, const StokesSettings& settings = {});

/// Computes R of an ellipsoid about its centre: the diagonal in its axes, rotation first; eq. (95),
/// to rounding. Semi-axes [m]; one may be 0: an elliptic disc.
/// @pre semi-axes finite, at least two of them positive
Vector6 ellipsoidResistance(const Vector3& semi_axes);

/// Computes R of a ball about its centre: 8 pi R^3, 6 pi R. @pre radius > 0 [m]
Vector6 sphereResistance(double radius);

/// Finds the centre of reaction [m], the point about which the coupling of R is symmetric (Brenner
/// 1964); eq. (96). @pre the translation block is positive definite
Vector3 centreOfReaction(const Matrix6& resistance);

}  // namespace ambient
