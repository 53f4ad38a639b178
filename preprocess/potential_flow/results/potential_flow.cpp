#include "preprocess/potential_flow/results/potential_flow.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/base/numerics.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/potential_flow/results/added_mass_parts.h"
#include "preprocess/potential_flow/solvers/flow_solver.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {

Eigen::Matrix<double, Eigen::Dynamic, 6> projectOnVertices(const PanelSurface& surface,
                                                           const PanelMoments& moments) {
  const Eigen::Index vertices = surface.vertexCount();
  AMBIENT_ASSERT(static_cast<Eigen::Index>(moments.size()) == surface.panelCount());
  Eigen::Matrix<double, Eigen::Dynamic, 6> load(vertices, 6);
  load.setZero();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index t = 0; t < surface.panelCount(); ++t)
    for (int a = 0; a < 3; ++a) {
      const int i = surface.triangles(a, t);
      load.row(i) += moments[t].row(a);
      for (int b = 0; b < 3; ++b)
        entries.emplace_back(i, surface.triangles(b, t),
                             surface.panels[t].area * (a == b ? 2 : 1) / 12);
    }
  for (Eigen::Index v = 0; v < vertices; ++v)
    if (surface.component[v] < 0) entries.emplace_back(v, v, 1);
  Eigen::SparseMatrix<double> mass(vertices, vertices);
  mass.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(mass).solve(load);
}

Matrix6 panelInertia(const Panel& panel, const Eigen::Matrix<double, 3, 6>& moments) {
  Matrix6 inertia = Matrix6::Zero();
  for (int a = 0; a < 3; ++a) {
    Vector6 g;
    g << panel.corner[a].cross(panel.normal), panel.normal;
    inertia -= g * moments.row(a);
  }
  return inertia;
}

namespace {

using Eigen::Index;
using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr double kDenseBytesPerPanel =
    15000;  // of near pairs and what is held between passes; measured

/// Assembles the matrix and factorises it.
class DenseSolver final : public FlowSolver {
 public:
  /// The surface must outlive the solver.
  /// @throws std::runtime_error if it would need more than `memory_limit` bytes.
  DenseSolver(const PanelSurface& surface, int threads, double memory_limit)
      : surface_(surface), threads_(threads) {
    requireMemory(surface.panelCount(), DenseSolver::bytesNeeded(), memory_limit);
    fixBlocksOfLargeProducts();
    near_ = findNearPanels(surface, threads);
  }

  const PanelSurface& surface() const override { return surface_; }

  double bytesNeeded() const override {
    const auto panels = static_cast<double>(surface_.panelCount());
    const auto vertices = static_cast<double>(surface_.vertexCount());
    return sizeof(double) * vertices * vertices + kDenseBytesPerPanel * panels;
  }

  Jump solveJump(const Unknowns& unknowns) override {
    Eigen::MatrixXd W = assembleHypersingular(surface_, unknowns, near_, threads_);
    fillKernel(surface_, unknowns, W);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(W);
    if (factors.info() != Eigen::Success)
      throw std::runtime_error("potential flow: the linear system of " +
                               std::to_string(unknowns.count) +
                               " vertices is not positive definite; two sides of the surface are "
                               "too close for the size of "
                               "its triangles: use more triangles, a sheet, or build --wrap");
    const MatrixX6 solution = factors.solve(-assembleNormalVelocity(surface_, unknowns));
    return {atVertices(unknowns, solution), 0};
  }

  PanelMoments computeMoments(const Jump& jump) override {
    return computeExteriorMoments(surface_, near_, jump.values, threads_);
  }

 private:
  const PanelSurface& surface_;
  int threads_;
  NearPanels near_;
};

double largestAsymmetry(const Matrix6& K) {
  const double largest = K.cwiseAbs().maxCoeff();
  return largest > 0 ? (K - K.transpose()).cwiseAbs().maxCoeff() / largest : 0;
}

/// -B^T mu: the inertia of the fluid on both sides of the surface; symmetric.
Matrix6 integrateEnergy(const PanelSurface& surface, const Unknowns& unknowns,
                        const MatrixX6& jump) {
  const MatrixX6 B = assembleNormalVelocity(surface, unknowns);
  Matrix6 K = Matrix6::Zero();
  for (Index v = 0; v < surface.vertexCount(); ++v)
    if (unknowns.of_vertex[v] >= 0) K -= B.row(unknowns.of_vertex[v]).transpose() * jump.row(v);
  return K;
}

/// -int phi_j g_i of each panel, from the potentials' moments.
std::vector<PanelInertia> integratePanels(const PanelSurface& surface,
                                          const PanelMoments& moments) {
  std::vector<PanelInertia> panels(static_cast<std::size_t>(surface.panelCount()));
  for (std::size_t t = 0; t < panels.size(); ++t) {
    const Panel& panel = surface.panels[t];
    const PanelArrays& arrays = surface.arrays;
    const auto i = static_cast<Index>(t);
    panels[t].normal = panel.normal;
    panels[t].centroid = panel.centroid;
    panels[t].area = panel.area;
    panels[t].spread << arrays.xx[i], arrays.yy[i], arrays.zz[i], arrays.xy[i], arrays.xz[i],
        arrays.yz[i];
    panels[t].inertia = panelInertia(panel, moments[t]);
  }
  return panels;
}

/// The inertia by definition.
Matrix6 sumOf(const std::vector<PanelInertia>& panels) {
  Matrix6 K = Matrix6::Zero();
  for (const PanelInertia& panel : panels) K += panel.inertia;
  return K;
}

/// Returns the moments of a potential that is linear on the panels.
PanelMoments momentsOf(const PanelSurface& surface, const MatrixX6& potential) {
  PanelMoments moments(static_cast<std::size_t>(surface.panelCount()));
  for (std::size_t t = 0; t < moments.size(); ++t) {
    const Eigen::Vector3i corners = surface.triangles.col(static_cast<Index>(t));
    Eigen::Matrix<double, 3, 6> values;
    for (int a = 0; a < 3; ++a) values.row(a) = potential.row(corners[a]);
    const Eigen::Matrix<double, 1, 6> sum = values.colwise().sum();
    moments[t] = surface.panels[t].area / 12 * (values.rowwise() + sum);
  }
  return moments;
}

// The solutions below are in the units of the solver, about the surface's centre.

PotentialFlow solveSheet(FlowSolver& solver) {
  const PanelSurface& surface = solver.surface();
  const Unknowns unknowns = numberUnknowns(surface);
  PotentialFlow flow;
  const Jump jump = solver.solveJump(unknowns);
  AMBIENT_ASSERT(jump.values.rows() == surface.vertexCount());
  flow.potential = jump.values;
  flow.iterations = jump.iterations;
  flow.added_mass = integrateEnergy(surface, unknowns, flow.potential);
  flow.asymmetry = largestAsymmetry(flow.added_mass);
  flow.parts = joinPanels(integratePanels(surface, momentsOf(surface, flow.potential)));
  return flow;
}

PotentialFlow solveClosed(FlowSolver& solver) {
  const PanelSurface& surface = solver.surface();
  const Unknowns unknowns = numberUnknowns(surface);
  const Jump jump = solver.solveJump(unknowns);
  const PanelMoments moments = solver.computeMoments(jump);
  const std::vector<PanelInertia> panels = integratePanels(surface, moments);
  AMBIENT_ASSERT(moments.size() == panels.size());
  AMBIENT_ASSERT(jump.iterations >= 0);
  const Matrix6 direct = sumOf(panels);

  PotentialFlow flow;
  flow.iterations = jump.iterations;
  flow.potential = projectOnVertices(surface, moments);
  flow.parts = joinPanels(panels);
  flow.asymmetry = largestAsymmetry(direct);
  // The energy holds the interior flow too. In translation that moves as a solid, volume times
  // unity and, about the centre of volume, without coupling; in rotation it is not known.
  flow.added_mass = integrateEnergy(surface, unknowns, jump.values);
  flow.added_mass.bottomRightCorner<3, 3>().diagonal().array() -= surface.volume;
  flow.added_mass.topLeftCorner<3, 3>() = direct.topLeftCorner<3, 3>();
  return flow;
}

void requireUnknowns(const TriangleMesh& sheet) {
  if (hasVerticesInside(sheet)) return;
  throw std::runtime_error("potential flow: the sheet of " + std::to_string(sheet.triangleCount()) +
                           " panels, or a part of it, has no vertex inside its boundary: it must "
                           "be divided into more panels");
}

void requireClosed(const PanelSurface& surface) {
  if (surface.boundary_edge_count > 0)
    throw std::runtime_error("potential flow: the surface is open at " +
                             std::to_string(surface.boundary_edge_count) +
                             " edges; it must be closed, or be declared a sheet");
  if (!(surface.volume > 0))
    throw std::runtime_error(
        "potential flow: the surface is inside out or encloses no volume; triangles must be "
        "counter-clockwise seen from the fluid");
}

bool isHierarchical(FlowSolverKind solver, Index panels) {
  return solver == FlowSolverKind::Hierarchical ||
         (solver == FlowSolverKind::Automatic && panels > kMostDensePanels);
}

PotentialFlow solveUnitFlow(const PanelSurface& surface, const PotentialFlowSettings& settings) {
  if (!settings.sheet) requireClosed(surface);
  const int threads = threadCount(settings.threads);
  const double limit = memoryLimit(settings.memory_limit);
  double bytes = 0;
  const auto solve = [&](FlowSolver&& solver) {
    bytes = solver.bytesNeeded();
    return settings.sheet ? solveSheet(solver) : solveClosed(solver);
  };
  try {
    return isHierarchical(settings.solver, surface.panelCount())
               ? solve(HierarchicalSolver(surface, threads, limit))
               : solve(DenseSolver(surface, threads, limit));
  } catch (const std::bad_alloc&) {
    raiseOutOfMemory(surface.panelCount(), bytes);
  }
}

/// Makes the inertia symmetric positive semi-definite; returns the lowest eigenvalue over the
/// largest if it was negative, else 0.
double removeNegativePart(Matrix6& K) {
  const auto values = symmetricEigen<6>(symmetricPart(K)).values;
  const double lowest = values[0], largest = values[5];
  K = positivePart(K);
  return lowest < 0 && largest > 0 ? lowest / largest : 0;
}

}  // namespace

PotentialFlow solvePotentialFlow(const TriangleMesh& mesh, const PotentialFlowSettings& settings) {
  if (mesh.triangleCount() == 0)
    throw std::runtime_error("potential flow: the mesh has 0 triangles; it needs at least 1");
  const TriangleMesh panels = refineSurface(mesh, settings.sheet, settings.max_panels);
  if (settings.sheet) requireUnknowns(panels);
  const PanelSurface surface = makePanelSurface(panels, settings.sheet);
  PotentialFlow flow = solveUnitFlow(surface, settings);
  flow.panels = surface.panelCount();
  flow.removed_eigenvalue = removeNegativePart(flow.added_mass);
  const double size = surface.length;
  flow.added_mass = symmetricPart(shiftOrigin(scaleShape(flow.added_mass, size), -surface.centre));
  AMBIENT_ASSERT(size > 0 && isSymmetric(flow.added_mass));
  flow.parts = placed(std::move(flow.parts), size, surface.centre);
  // The mesh's vertices come first. A rotation about its origin moves the centre c with w x c.
  const MatrixX6 own = flow.potential.topRows(mesh.vertexCount());
  flow.potential.resize(mesh.vertexCount(), 6);
  flow.potential.rightCols<3>() = size * own.rightCols<3>();
  flow.potential.leftCols<3>() =
      size * size * own.leftCols<3>() - flow.potential.rightCols<3>() * crossMatrix(surface.centre);
  return flow;
}

}  // namespace ambient
