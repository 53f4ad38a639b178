#pragma once

#include "preprocess/potential_flow/results/potential_flow.h"

namespace ambient {

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
/// flat sides are merged before they are divided and none bulges; its divisions disagree from 10 %
/// on, and it then gets kMostDensePanels.
/// @throws std::runtime_error as solvePotentialFlow().
RefinedFlow solveRefinedFlow(const TriangleMesh& mesh, const PotentialFlowSettings& settings);

}  // namespace ambient
