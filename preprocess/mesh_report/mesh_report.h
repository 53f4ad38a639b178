#pragma once

#include <optional>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/triangle_quality.h"
#include "preprocess/potential_flow/results/potential_flow.h"

namespace ambient {

/// One solution of the potential flow.
struct FlowLevel {
  Eigen::Index panels = 0;
  double seconds = 0;
  Matrix6 added_mass = Matrix6::Zero();  ///< per unit density, about the origin of the report
  double asymmetry = 0;                  ///< as in PotentialFlow
  double condition = 0;  ///< estimate of the condition number of its linear system, in the 1-norm
};

/// Estimate of the result of a build, with its extrapolation and its symmetries.
struct BuildEstimate {
  Eigen::Index panels = 0, coarse_panels = 0;
  Matrix6 added_mass = Matrix6::Zero();  ///< per unit density, about the origin of the report
  /// Difference to a build on `coarse_panels` over the largest entry of the block [1]: mostly more
  /// than the error, by a factor of 1 to 10.
  double rotation_error = 0, translation_error = 0;
};

/// Report on the accuracy to expect of the fluid body of a mesh.
struct MeshReport {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< centre of volume, for a sheet of area [m]
  FlowLevel built;                                   ///< plain solution on settings.max_panels
  /// Solution on fewer panels or, if the mesh itself is too fine for that, on more.
  std::optional<FlowLevel> other;
  /// Estimated error of `built` over the largest entry of the block, from both levels, the error
  /// taken as inverse to the number of panels [1]. It knows the polyhedron only, not the smooth
  /// body that the mesh may stand for.
  double rotation_error = 0, translation_error = 0;
  Matrix6 extrapolated = Matrix6::Zero();  ///< `built` corrected by that error
  /// Estimate of a build; none if the build solves on the mesh's own triangles, as for a smooth or
  /// fine mesh.
  std::optional<BuildEstimate> build;
  std::vector<TriangleQuality> worst_triangles;
  std::optional<Thickness> thinnest;  ///< thinnest part of a body; none for a sheet
};

/// Makes the report for settings.max_panels, as for the fluid body. Lists three worst triangles.
/// Cost: that of solvePotentialFlow() on both levels, where the finer one has at most 8000 panels
/// or those of the mesh, and of two builds.
/// @pre the mesh passed checkMesh() as a body or as a sheet.
/// @throws std::runtime_error as solvePotentialFlow().
MeshReport makeMeshReport(const TriangleMesh& mesh, const PotentialFlowSettings& settings);

}  // namespace ambient
