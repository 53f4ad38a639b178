#include "preprocess/potential_flow/results/flow_estimate.h"

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

double blockError(const Matrix6& error, const Matrix6& value, int first) {
  const double scale = value.block<3, 3>(first, first).cwiseAbs().maxCoeff();
  return scale > 0 ? error.block<3, 3>(first, first).cwiseAbs().maxCoeff() / scale : 0;
}

FlowEstimate estimateOf(const Matrix6& error, const Matrix6& added_mass, Eigen::Index panels,
                        Eigen::Index other_panels) {
  return {panels, other_panels, blockError(error, added_mass, 0), blockError(error, added_mass, 3)};
}

/// Compares with a build on half or a third of the panels.
std::optional<FlowEstimate> compareWithFewer(const TriangleMesh& mesh, const RefinedFlow& fine,
                                             PotentialFlowSettings settings) {
  for (const int divisor : {2, 3}) {
    settings.max_panels = static_cast<int>(fine.panels) / divisor;
    const RefinedFlow coarse = solveRefinedFlow(mesh, settings);
    if (5 * coarse.panels <= 4 * fine.panels)
      return estimateOf(fine.added_mass - coarse.added_mass, fine.added_mass, fine.panels,
                        coarse.panels);
  }
  return std::nullopt;
}

/// Compares the plain solution on the triangles with that on about four times as many.
std::optional<FlowEstimate> compareWithMore(const TriangleMesh& mesh,
                                            PotentialFlowSettings settings) {
  constexpr int kMostPanels = 8000;
  const TriangleMesh finer = divideTriangles(mesh, 3 * static_cast<int>(mesh.triangleCount()));
  if (finer.triangleCount() > kMostPanels) return std::nullopt;
  settings.max_panels = 0;
  const PotentialFlow few = solvePotentialFlow(mesh, settings),
                      many = solvePotentialFlow(finer, settings);
  // K(P) = K + c / P.
  const double ratio = static_cast<double>(few.panels) / static_cast<double>(many.panels);
  const Matrix6 error = (few.added_mass - many.added_mass) / (1 - ratio);
  return estimateOf(error, few.added_mass - error, few.panels, many.panels);
}

}  // namespace

std::optional<FlowEstimate> estimateFlow(const TriangleMesh& mesh,
                                         const PotentialFlowSettings& settings) {
  TriangleMesh centred = mesh;
  centred.vertices.colwise() -= computeMassProperties(mesh, settings.sheet).uniform.centre;
  const TriangleMesh basis = mergeFlatTriangles(centred, settings.sheet, settings.max_panels);
  if (settings.max_panels > basis.triangleCount()) {
    const RefinedFlow fine = solveRefinedFlow(basis, settings);
    if (fine.panels != basis.triangleCount())
      if (const auto estimate = compareWithFewer(basis, fine, settings)) return estimate;
  }
  return compareWithMore(refineSurface(basis, settings.sheet, settings.max_panels), settings);
}

}  // namespace ambient
