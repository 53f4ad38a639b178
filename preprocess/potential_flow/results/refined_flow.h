#pragma once

#include <optional>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/surface/panel_surface.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {

/// Change of a body's volume and added mass if its flat triangles bulge to the smooth surface that
/// they approximate; first order in the height, docs/theory.md eq. (11a). Zero without bulges.
struct CurvatureCorrection {
  Matrix6 added_mass = Matrix6::Zero();  ///< about the mesh's origin, per unit density
  double volume = 0;                     ///< [m^3]
};

/// Computes the correction.
/// @param mesh mesh whose triangles approximate a smooth surface
/// @param bulges estimateBulges() of the mesh
/// @param panels the same flat surface, divided
/// @param potential V x 6 of the panels' vertices, outside, of unit motions about the mesh's origin
CurvatureCorrection computeCurvatureCorrection(
    const TriangleMesh& mesh, const std::vector<FaceBulge>& bulges, const DividedSurface& panels,
    const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential);

/// Added mass of the body that a mesh approximates.
struct RefinedFlow {
  Matrix6 added_mass = Matrix6::Zero();  ///< per unit density, about the mesh's origin
  std::vector<AddedMassPart> parts;      ///< as PotentialFlow::parts, without corrections
  double asymmetry = 0;                  ///< as PotentialFlow::asymmetry
  Eigen::Index panels = 0;               ///< largest number of panels of all solutions
  /// True: long triangles left too few panels across sharp edges, even after a refinement. Rotation
  /// entries may then be wrong by some, at worst tens of per cent of the largest one.
  bool is_coarse = false;
  /// The surface without the divisions of its faces, and its potentials as
  /// PotentialFlow::potential.
  TriangleMesh surface{};
  Eigen::Matrix<double, Eigen::Dynamic, 6> potential{};
};

/// solvePotentialFlow() with corrections that cost next to nothing. Where flat faces with sharp
/// edges are divided, the result is extrapolated from two divisions, the coarser one with about a
/// quarter of the panels. Where there is no room to divide the faces of a polyhedron, the coarser
/// division is one level less thin across sharp edges. A closed mesh of one piece without sharp
/// edges stands for a smooth body of the same volume: to first order its triangles bulge up to it;
/// if all of it is curved, its own triangles are the panels. A closed mesh of more than eight times
/// as many triangles as settings.max_panels is solved inFewerTriangles(). Entries that the
/// symmetries of the body forbid are removed, however its faces are cut. A mesh of long triangles
/// on which two divisions disagree gets panels that are cut from compactSurface(), or else four
/// times as many, unless the dense solver was asked for. Of a polyhedron, settings.polyhedron, all
/// flat sides are merged before they are divided and none bulges; many small sides become
/// fewer ones about as long as wide, and of a convex one fewer still. Its divisions disagree from
/// 10 % on: a convex one then gets twice as many panels, another one kMostDensePanels.
/// @throws std::runtime_error as solvePotentialFlow().
RefinedFlow solveRefinedFlow(const TriangleMesh& mesh, const PotentialFlowSettings& settings);

/// Estimated error of the added mass of a mesh: its difference to a solution on another number of
/// panels. It knows the polyhedron only, not the smooth body that the mesh may stand for.
struct FlowEstimate {
  Eigen::Index panels = 0, other_panels = 0;
  double rotation_error = 0, translation_error = 0;  ///< over the largest entry of the block [1]
};

/// Estimates the error of a build. Where it divides the mesh, the other solution has a half or a
/// third of its panels; the difference is mostly more than the error. Where it solves on the mesh's
/// own triangles, as for a smooth or fine mesh, or so few are not possible, plain solutions on
/// these panels and on four times as many are compared, with an error that is inverse to their
/// number; none if these are more than 8000.
/// @pre the mesh passed checkMesh() as a body or as a sheet.
/// @throws std::runtime_error as solvePotentialFlow().
std::optional<FlowEstimate> estimateFlow(const TriangleMesh& mesh,
                                         const PotentialFlowSettings& settings);

/// Part of every fluid body's provenance, so that files of an older revision are built anew. Raise
/// it with every change after which the same mesh or shape with the same settings gives numbers
/// that differ by more than rounding: added mass and its parts, faces of a shape, reduced loads.
constexpr int kSolverRevision = 23;

}  // namespace ambient
