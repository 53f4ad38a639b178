#include "preprocess/mesh_report/mesh_report.h"

#include <chrono>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

/// On the triangles of the surface.
FlowLevel solveLevel(const TriangleMesh& surface, const PotentialFlowSettings& settings) {
  PotentialFlowSettings undivided = settings;
  undivided.max_panels = 0;
  const auto start = std::chrono::steady_clock::now();
  const PotentialFlow flow = solvePotentialFlow(surface, undivided);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return {flow.panels, seconds.count(), flow.added_mass, flow.asymmetry,
          flow.reciprocal_condition > 0 ? 1 / flow.reciprocal_condition : 0};
}

/// A solution on clearly fewer panels, or on about four times as many if there is none.
std::optional<FlowLevel> solveOther(const TriangleMesh& mesh, const FlowLevel& built,
                                    const PotentialFlowSettings& settings) {
  constexpr int kMostPanels = 8000;
  for (const int divisor : {2, 3}) {
    const auto fewer = static_cast<int>(built.panels / divisor);
    const TriangleMesh coarser = refineSurface(mesh, settings.sheet, fewer);
    if (5 * coarser.triangleCount() <= 4 * built.panels) return solveLevel(coarser, settings);
  }
  const auto panels = static_cast<int>(built.panels);
  const TriangleMesh more =
      divideTriangles(refineSurface(mesh, settings.sheet, settings.max_panels), 3 * panels);
  if (more.triangleCount() > kMostPanels) return std::nullopt;
  return solveLevel(more, settings);
}

double blockError(const Matrix6& error, const Matrix6& value, int first) {
  const double scale = value.block<3, 3>(first, first).cwiseAbs().maxCoeff();
  return scale > 0 ? error.block<3, 3>(first, first).cwiseAbs().maxCoeff() / scale : 0;
}

/// A build, compared with one on about half or a third of its panels.
std::optional<BuildEstimate> estimateBuild(const TriangleMesh& mesh,
                                           const PotentialFlowSettings& settings) {
  if (settings.max_panels <= mesh.triangleCount()) return std::nullopt;
  const auto solve = [&](int panels) {
    PotentialFlowSettings divided = settings;
    divided.max_panels = panels;
    return solveRefinedFlow(mesh, divided);
  };
  const RefinedFlow fine = solve(settings.max_panels);
  if (fine.panels == mesh.triangleCount()) return std::nullopt;
  for (const int divisor : {2, 3}) {
    const RefinedFlow coarse = solve(static_cast<int>(fine.panels) / divisor);
    if (5 * coarse.panels > 4 * fine.panels) continue;
    const Matrix6 difference = fine.added_mass - coarse.added_mass;
    return BuildEstimate{fine.panels, coarse.panels, fine.added_mass,
                         blockError(difference, fine.added_mass, 0),
                         blockError(difference, fine.added_mass, 3)};
  }
  return std::nullopt;
}

}  // namespace

MeshReport makeMeshReport(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  MeshReport report;
  report.origin = computeMassProperties(mesh, settings.sheet).uniform.centre;
  TriangleMesh centred = mesh;
  centred.vertices.colwise() -= report.origin;
  report.worst_triangles = findWorstTriangles(mesh, 3);
  if (!settings.sheet) report.thinnest = findThinnestPart(mesh);

  const TriangleMesh basis = mergeFlatTriangles(centred, settings.sheet, settings.max_panels);
  report.build = estimateBuild(basis, settings);
  report.built = solveLevel(refineSurface(basis, settings.sheet, settings.max_panels), settings);
  report.extrapolated = report.built.added_mass;
  report.other = solveOther(basis, report.built, settings);
  if (!report.other) return report;
  // K(P) = K + c / P.
  const auto built = static_cast<double>(report.built.panels),
             other = static_cast<double>(report.other->panels);
  const Matrix6 error =
      (report.built.added_mass - report.other->added_mass) * (other / (other - built));
  report.extrapolated = report.built.added_mass - error;
  report.rotation_error = blockError(error, report.extrapolated, 0);
  report.translation_error = blockError(error, report.extrapolated, 3);
  return report;
}

}  // namespace ambient
