#pragma once

#include <optional>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/potential_flow.h"

namespace ambient {

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

}  // namespace ambient
