#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/operators/far_moments.h"

namespace ambient {

/// Vertex values (V x 6) of the continuous piecewise linear functions with the given moments: the
/// L2 projection. 0 at vertices without a panel. Cost: one sparse factorisation.
Eigen::Matrix<double, Eigen::Dynamic, 6> projectOnVertices(const PanelSurface& surface,
                                                           const PanelMoments& moments);

/// Contribution of one panel to the inertia: -int g phi^T, not symmetric.
Matrix6 panelInertia(const Panel& panel, const Eigen::Matrix<double, 3, 6>& moments);

/// Method of solving the linear system: by factorisation, or iteratively with a tree of panels.
enum class FlowSolverKind { Automatic, Dense, Hierarchical };

/// Largest number of panels for which Automatic means Dense: that into which a build divides a mesh
/// by default. The hierarchical solver is faster above 1300 (sphere) to 3000 (thin ellipsoid)
/// panels.
constexpr Eigen::Index kMostDensePanels = 4200;

/// Settings for solving the six exterior Neumann problems.
struct PotentialFlowSettings {
  bool sheet = false;  ///< the mesh is an open surface of zero thickness
  int max_panels = 0;  ///< largest number of panels that flat faces are cut into where the flow
                       ///< needs them, see refineSurface(); 0: every face is a panel
  int threads = 0;     ///< 0: all cores; the result does not depend on it, bit for bit
  FlowSolverKind solver = FlowSolverKind::Automatic;
  double memory_limit = 0;  ///< [bytes]; 0: the memory available on the machine
  /// The body is this polyhedron, and not a round one that its triangles approximate: see
  /// solveRefinedFlow().
  bool polyhedron = false;
  bool convex = false;  ///< a polyhedron without hollows: fewer panels do
};

/// Potentials of the six unit motions and the fluid's inertia, per unit density, about the mesh's
/// origin.
struct PotentialFlow {
  /// V x 6, continuous piecewise linear [m^2/s per unit motion], rotation first; for a sheet its
  /// jump, front (where the normal points to) minus back.
  Eigen::Matrix<double, Eigen::Dynamic, 6> potential;
  /// Symmetric positive semi-definite, rotation first.
  Matrix6 added_mass = Matrix6::Zero();
  /// Contributions of patches of the surface. Their sum differs from the added mass by its
  /// discretisation error. Rounded to single precision.
  std::vector<AddedMassPart> parts;
  /// Largest |K - K^T| over the largest |K| of K = -int phi_j g_i dA integrated directly, before
  /// any symmetrising; about the centre of volume, lengths divided by the body's size [1]. A
  /// measure of the discretisation; rounding only for sheets.
  double asymmetry = 0;
  /// Discretisation may leave tiny negative eigenvalues where the true inertia vanishes (spin of a
  /// body of revolution about its axis): they are set to zero. The lowest eigenvalue before that,
  /// or 0, over the largest; in the same units [1].
  double removed_eigenvalue = 0;
  Eigen::Index panels = 0;  ///< number of panels of the solution
  int iterations = 0;       ///< iterations of the hierarchical solver; 0: the matrix was factorised
};

/// Solves the six exterior Neumann problems dphi/dn = n.(v + w x z) by a Galerkin boundary element
/// method with the hypersingular operator; docs/theory.md eq. (6) to (11). Disjoint components are
/// solved together. Cost for P panels: dense, time O(P^2) + O(P^3) with small constants, memory 2
/// P^2 bytes and about 15 kB per panel; 2700 panels take 0.6 s of one core and 60 MB. Hierarchical,
/// O(P log P): 100 000 panels take 12 to 45 s of one core and 0.4 to 0.6 GB.
/// @pre the mesh passed checkMesh(): closed, manifold and outward oriented (or a manifold open
/// sheet).
/// @throws std::runtime_error for no triangles, a triangle without area, an open or inside-out
/// surface that is not a sheet, a sheet with a part without vertices inside its boundary, a
/// linear system that cannot be solved, or more memory than the limit, with the
/// reason.
PotentialFlow solvePotentialFlow(const TriangleMesh& mesh,
                                 const PotentialFlowSettings& settings = {});

}  // namespace ambient
