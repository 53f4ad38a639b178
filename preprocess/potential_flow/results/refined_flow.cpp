#include "preprocess/potential_flow/results/refined_flow.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/numerics.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/panel.h"
#include "preprocess/potential_flow/surface/shape_symmetry.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

Panel panelOf(const TriangleMesh& mesh, Index t) {
  return makePanel(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// Height of the smooth surface over a point of the face.
double heightAt(const Panel& face, const FaceBulge& bulge, const Vector3d& x) {
  Vector3d hat;
  for (int a = 0; a < 3; ++a) hat[a] = 1.0 / 3 + face.hatGradient(a).dot(x - face.centroid);
  return 4 * (bulge[0] * hat[0] * hat[1] + bulge[1] * hat[1] * hat[2] + bulge[2] * hat[2] * hat[0]);
}

/// Velocities of the six unit motions at x.
Matrix36 velocitiesAt(const Vector3d& x) {
  Matrix36 u;
  u << -crossMatrix(x), Eigen::Matrix3d::Identity();
  return u;
}

}  // namespace

CurvatureCorrection computeCurvatureCorrection(
    const TriangleMesh& mesh, const std::vector<FaceBulge>& bulges, const DividedSurface& panels,
    const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential) {
  CurvatureCorrection correction;
  if (bulges.empty()) return correction;
  AMBIENT_ASSERT(static_cast<Index>(bulges.size()) == mesh.triangleCount());
  AMBIENT_ASSERT(potential.rows() == mesh.vertexCount() ||
                 potential.rows() == panels.mesh.vertexCount());
  for (Index t = 0; t < panels.mesh.triangleCount(); ++t) {
    const int face_number = panels.face[t];
    const Panel face = panelOf(mesh, face_number), panel = panelOf(panels.mesh, t);
    Matrix36 flow = Matrix36::Zero();  // along the panel
    for (int a = 0; a < 3; ++a)
      flow += panel.hatGradient(a) * potential.row(panels.mesh.triangles(a, t));
    const Eigen::Matrix3d along =
        Eigen::Matrix3d::Identity() - panel.normal * panel.normal.transpose();
    for (const TriangleNode& node : kTriangleRule6) {
      const Vector3d x = panel.at(node.barycentric);
      const double layer = node.weight * panel.area * heightAt(face, bulges[face_number], x);
      const Matrix36 u = velocitiesAt(x), slip = along * u - flow;
      correction.added_mass += layer * (slip.transpose() * slip - u.transpose() * u);
      correction.volume += layer;
    }
  }
  return correction;
}

namespace {

// Order of the error in the length of the panels at edges they are thinned across; measured 2.1 to
// 3.2, docs/accuracy.md.
constexpr double kOrder = 2.25;
// Order of that error for polyhedra on about a thousand panels, fitted to hulls of points and
// unions of boxes: by kOrder nearly all come out too light.
constexpr double kPolyhedronOrder = 2.1;

// On compact panels, as smooth bodies have them, expansions pay earlier than kMostDensePanels.
constexpr Eigen::Index kMostDenseSmoothPanels = 2000;

/// To panels of no size, from the added mass on both levels.
Matrix6 extrapolated(const PotentialFlow& fine, const PotentialFlow& coarse, double order) {
  AMBIENT_ASSERT(fine.panels > coarse.panels);
  const double ratio = static_cast<double>(fine.panels) / static_cast<double>(coarse.panels);
  return fine.added_mass +
         (fine.added_mass - coarse.added_mass) / (portable::pow(ratio, order / 2) - 1);
}

/// Relative to the largest entry of its block, the larger one of rotation and translation.
double changeOf(const Matrix6& before, const Matrix6& after) {
  double largest = 0;
  for (const int block : {0, 3}) {
    const Matrix3 now = after.block<3, 3>(block, block);
    const double change = (now - before.block<3, 3>(block, block)).cwiseAbs().maxCoeff();
    const double size = now.cwiseAbs().maxCoeff();
    if (size > 0) largest = std::max(largest, change / size);
  }
  return largest;
}

// On 4200 panels, cylinders of 16 strips as long as wide are extrapolated by 1 % and come out 0.5 %
// off, those of 32 by 4 and 3 %. Those of 64 change by 21 % with a level across the rims and are
// 10 % off.
constexpr double kLargeChange = 0.02;
constexpr double kLongTriangle = 3;  // aspect
constexpr double kLargePolyhedronChange = 0.1;

// Error of the energy after a halving of the panels across edges over that before it: 2^(-4/3), for
// the potential at the edges of a box goes with r^(2/3).
constexpr double kThinnedError = 0.3968502629920499;

/// To panels that are infinitely thin at the edges, from one level of thinning to the next.
Matrix6 extrapolatedAcrossEdges(const Matrix6& fine, const Matrix6& less_thinned) {
  return fine + kThinnedError / (1 - kThinnedError) * (fine - less_thinned);
}

/// The flow on panels that a surface was divided into.
RefinedFlow refinedFrom(const PotentialFlow& flow, const TriangleMesh& surface) {
  AMBIENT_ASSERT(flow.potential.rows() >= surface.vertexCount());
  return {flow.added_mass,
          flow.parts,
          flow.asymmetry,
          flow.panels,
          false,
          surface,
          flow.potential.topRows(surface.vertexCount())};
}

/// A mesh as solveOnPanels() divides it into up to settings.max_panels.
struct Division {
  std::vector<FaceBulge> bulges;  ///< empty: it has sharp edges, or is a sheet
  bool is_smooth = false;
  TriangleMesh basis;
  SurfaceLevels levels;
  /// True: triangles so long that two levels have to agree, unless the body is smooth.
  bool has_long_triangles = false;

  /// True if it has sharp edges and no panels are left for them. No flow has to be solved to know.
  bool isCoarse() const {
    return has_long_triangles && !levels.coarse && !levels.less_thinned && bulges.empty();
  }
};

Division divisionOf(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  Division division;
  if (!settings.sheet) division.bulges = estimateBulges(mesh);
  division.is_smooth = areSmooth(division.bulges);
  division.basis = division.bulges.empty()
                       ? mergeFlatTriangles(mesh, settings.sheet, settings.max_panels)
                       : mesh;
  division.levels =
      refineInLevels(division.basis, settings.sheet, division.is_smooth ? 0 : settings.max_panels);
  division.has_long_triangles =
      !division.is_smooth && !settings.sheet && mesh.triangleCount() < settings.max_panels &&
      findWorstTriangles(division.basis, 1).front().aspect > kLongTriangle;
  return division;
}

// About the body of `mesh`, which was divided by these settings.
RefinedFlow solveOn(const Division& division, const TriangleMesh& mesh,
                    const PotentialFlowSettings& settings) {
  const SurfaceLevels& levels = division.levels;
  PotentialFlowSettings undivided_settings = settings;
  undivided_settings.max_panels = 0;
  if (division.is_smooth && settings.solver == FlowSolverKind::Automatic &&
      mesh.triangleCount() > kMostDenseSmoothPanels)
    undivided_settings.solver = FlowSolverKind::Hierarchical;
  const PotentialFlow flow = solvePotentialFlow(levels.fine.mesh, undivided_settings);
  RefinedFlow refined = refinedFrom(flow, division.basis);
  refined.is_coarse = division.isCoarse();
  if (levels.coarse && (!settings.sheet || hasVerticesInside(*levels.coarse))) {
    const PotentialFlow coarse = solvePotentialFlow(*levels.coarse, undivided_settings);
    refined.added_mass = extrapolated(flow, coarse, kOrder);
  }
  if (division.has_long_triangles && levels.coarse) {
    refined.is_coarse = changeOf(flow.added_mass, refined.added_mass) > kLargeChange;
  } else if (division.has_long_triangles && levels.less_thinned) {
    const PotentialFlow other = solvePotentialFlow(*levels.less_thinned, undivided_settings);
    refined.is_coarse = changeOf(other.added_mass, flow.added_mass) > kLargeChange;
  }
  double stretch = 1;
  if (!settings.sheet) {
    const CurvatureCorrection correction =
        computeCurvatureCorrection(mesh, division.bulges, levels.fine, flow.potential);
    refined.added_mass += correction.added_mass;
    const double volume = computeMassProperties(mesh).volume;
    stretch = portable::cbrt(volume / (volume + correction.volume));
  }
  refined.added_mass =
      withSymmetriesOf(mesh, settings.sheet, refined.added_mass, scaleShape, stretch);
  return refined;
}

RefinedFlow solveOnPanels(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  return solveOn(divisionOf(mesh, settings), mesh, settings);
}

constexpr int kPanelsPerTriangle = 5;  // where triangles are to be divided

/// Triangles about as long as wide in place of a polyhedron's many strips; none if it has few
/// sides, or details that they do not show. Panels that are cut from them are fewer and more exact:
/// links of robots, as hulls on 600 panels, are 0.5 % off in translation and 1.9 % in rotation in
/// the mean, against 6000; unions of prisms of 32 sides come out up to 12 % too light in rotation
/// on 1500 panels of their own strips, a robot's torso of 16 shapes 38 %. Unions whose mesh,
/// divided for the loads, cannot be coarsened so far often can from their sides alone. Else those
/// of more sides than 4/3 settings.max_panels get so many triangles.
std::optional<TriangleMesh> inCompactTriangles(const TriangleMesh& mesh, const TriangleMesh& sides,
                                               int triangles,
                                               const PotentialFlowSettings& settings) {
  if (sides.triangleCount() <= (settings.convex ? triangles / 2 : triangles)) return std::nullopt;
  auto compact = inFewerTriangles(mesh, triangles);
  if (!compact && !settings.convex) compact = inFewerTriangles(sides, triangles);
  const int most = 4 * settings.max_panels / 3;
  if (!compact && sides.triangleCount() > most) compact = inFewerTriangles(sides, most);
  return compact;
}

RefinedFlow solvePolyhedron(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  const TriangleMesh sides = mergePolyhedronSides(mesh);
  const int fewer = 2 * settings.max_panels / (settings.convex ? 5 : 3);
  const auto compact = inCompactTriangles(mesh, sides, fewer / kPanelsPerTriangle, settings);
  SurfaceLevels levels = compact ? refineInLevels(*compact, false, fewer)
                                 : refineInLevels(sides, false, settings.max_panels);
  // Triangles that could not become few are not divided: others make the second level.
  if (compact && compact->triangleCount() > settings.max_panels)
    levels.coarse = inFewerTriangles(sides, settings.max_panels);
  PotentialFlowSettings undivided = settings;
  undivided.max_panels = 0;
  const PotentialFlow flow = solvePotentialFlow(levels.fine.mesh, undivided);
  RefinedFlow refined = refinedFrom(flow, compact ? levels.fine.mesh : sides);
  if (levels.coarse) {
    const PotentialFlow coarse = solvePotentialFlow(*levels.coarse, undivided);
    refined.added_mass = extrapolated(flow, coarse, kPolyhedronOrder);
  } else if (levels.less_thinned) {
    refined.added_mass = extrapolatedAcrossEdges(
        flow.added_mass, solvePotentialFlow(*levels.less_thinned, undivided).added_mass);
  }
  refined.is_coarse = changeOf(flow.added_mass, refined.added_mass) > kLargePolyhedronChange;
  refined.added_mass = withSymmetriesOf(mesh, false, refined.added_mass, scaleShape);
  return refined;
}

RefinedFlow solveDivided(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  AMBIENT_ASSERT(!settings.polyhedron || !settings.sheet);
  return settings.polyhedron ? solvePolyhedron(mesh, settings) : solveOnPanels(mesh, settings);
}

/// Solves the flow around the body of a mesh in other triangles. A difference of two divisions is
/// then not due to long triangles.
RefinedFlow solveInOtherTriangles(const TriangleMesh& other, const TriangleMesh& mesh,
                                  const PotentialFlowSettings& settings) {
  RefinedFlow refined = solveOnPanels(other, settings);
  refined.is_coarse = false;
  refined.added_mass = withSymmetriesOf(mesh, false, refined.added_mass, scaleShape);
  return refined;
}

/// On panels that are cut from triangles about as long as wide; none if the body has none such.
std::optional<RefinedFlow> solveOnCompactPanels(const TriangleMesh& mesh,
                                                const PotentialFlowSettings& settings) {
  constexpr int kLeastPanels = 2000;
  if (settings.sheet || settings.max_panels < kLeastPanels) return std::nullopt;
  const auto compact = compactSurface(mesh, settings.max_panels / kPanelsPerTriangle);
  if (!compact) return std::nullopt;
  return solveInOtherTriangles(*compact, mesh, settings);
}

/// Whether a mesh has far more triangles than panels were asked for. Sheets are no closed meshes.
bool isFarFiner(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  constexpr Eigen::Index kTrianglesPerPanel = 8;
  return !settings.sheet && settings.max_panels > 0 &&
         mesh.triangleCount() > kTrianglesPerPanel * settings.max_panels;
}

/// Triangles for so many panels: one for each if the body is smooth, else some to be divided. None
/// if so few do not show the body.
std::optional<TriangleMesh> inTrianglesFor(int panels, const TriangleMesh& mesh) {
  constexpr int kFewTriangles = 400;
  std::optional<TriangleMesh> fewer = inFewerTriangles(mesh, panels);
  const int divisible = std::max(kFewTriangles, panels / kPanelsPerTriangle);
  if (!fewer || divisible >= panels || areSmooth(estimateBulges(*fewer))) return fewer;
  return inFewerTriangles(*fewer, divisible);
}

}  // namespace

RefinedFlow solveRefinedFlow(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  if (isFarFiner(mesh, settings)) {
    if (const auto fewer = inTrianglesFor(settings.max_panels, mesh))
      return solveInOtherTriangles(*fewer, mesh, settings);
  }
  const bool may_repeat = settings.solver != FlowSolverKind::Dense;
  if (settings.polyhedron) {
    const RefinedFlow refined = solvePolyhedron(mesh, settings);
    if (!refined.is_coarse || !may_repeat) return refined;
  } else {
    const Division division = divisionOf(mesh, settings);
    if (!may_repeat || !division.isCoarse()) {
      const RefinedFlow refined = solveOn(division, mesh, settings);
      if (!refined.is_coarse || !may_repeat) return refined;
    }
  }
  if (const auto compact = solveOnCompactPanels(mesh, settings)) return *compact;
  PotentialFlowSettings finer = settings;
  finer.max_panels = settings.polyhedron && !settings.convex
                         ? static_cast<int>(kMostDensePanels)
                         : (settings.polyhedron ? 2 : 4) * settings.max_panels;
  return solveDivided(mesh, finer);
}

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
