#include "preprocess/waterline/waterline_builder.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/numerics.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/panel_surface.h"
#include "preprocess/potential_flow/surface/shape_symmetry.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::Vector3i;

/// Cuts triangles at z = 0. Points of the waterline are numbered before the mesh's own.
class WaterlineCut {
 public:
  explicit WaterlineCut(const TriangleMesh& body) : body_(body) {
    for (Index t = 0; t < body.triangleCount(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int a = body.triangles(k, t), b = body.triangles((k + 1) % 3, t);
        if (isWet(a) != isWet(b)) addCrossing(std::minmax(a, b));
      }
    for (Index t = 0; t < body.triangleCount(); ++t) addWetPart(body.triangles.col(t));
  }

  TriangleMesh mesh() const {
    std::vector<Vector3d> vertices = crossings_;
    for (Index v = 0; v < body_.vertexCount(); ++v) vertices.push_back(body_.vertices.col(v));
    return makeTriangleMesh(vertices, triangles_);
  }

 private:
  bool isWet(int vertex) const { return body_.vertices(2, vertex) < 0; }

  void addCrossing(const std::pair<int, int>& edge) {
    if (!numbers_.emplace(edge, static_cast<int>(crossings_.size())).second) return;
    const Vector3d a = body_.vertices.col(edge.first), b = body_.vertices.col(edge.second);
    Vector3d point = a + a.z() / (a.z() - b.z()) * (b - a);
    point.z() = 0;
    crossings_.push_back(point);
  }

  /// The polygon of the wet corners and the crossings, as a fan.
  void addWetPart(const Vector3i& corners) {
    std::vector<int> polygon;
    for (int k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      if (isWet(a)) polygon.push_back(static_cast<int>(crossings_.size()) + a);
      if (isWet(a) != isWet(b)) polygon.push_back(numbers_.at(std::minmax(a, b)));
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      triangles_.emplace_back(polygon[0], polygon[k], polygon[k + 1]);
  }

  const TriangleMesh& body_;
  std::map<std::pair<int, int>, int> numbers_;
  std::vector<Vector3d> crossings_;
  std::vector<Vector3i> triangles_;
};

/// Without triangles in the plane z = 0, which welding may leave, and vertices without a triangle.
TriangleMesh withoutLid(const TriangleMesh& mesh) {
  std::vector<Vector3i> triangles;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3i corners = mesh.triangles.col(t);
    if (!std::all_of(corners.begin(), corners.end(),
                     [&](int v) { return mesh.vertices(2, v) == 0; }))
      triangles.push_back(corners);
  }
  return withUsedVertices(mesh.vertices, triangles);
}

}  // namespace

TriangleMesh wetPartOf(const TriangleMesh& body) {
  constexpr double kClose = 1e-3, kInSurface = 1e-9;
  const double size = body.extents().maxCoeff();
  TriangleMesh placed = body;
  for (double& z : placed.vertices.row(2))
    if (std::abs(z) <= kInSurface * size) z = 0;
  return withoutLid(weldVertices(WaterlineCut(placed).mesh(), kClose * size));
}

MirroredMesh withImage(const TriangleMesh& wet) {
  MirroredMesh mirrored;
  AMBIENT_ASSERT(wet.vertexCount() == 0 || wet.vertices.row(2).maxCoeff() <= 0);
  mirrored.image.resize(wet.vertexCount());
  std::vector<Vector3d> vertices = columnsOf(wet.vertices);
  for (Index v = 0; v < wet.vertexCount(); ++v) {
    const Vector3d point = wet.vertices.col(v);
    mirrored.image[v] = static_cast<int>(point.z() == 0 ? v : vertices.size());
    if (point.z() != 0) vertices.emplace_back(point.x(), point.y(), -point.z());
  }
  std::vector<Vector3i> triangles = columnsOf(wet.triangles);
  for (Index t = 0; t < wet.triangleCount(); ++t) {
    const Vector3i corners = wet.triangles.col(t);
    triangles.emplace_back(mirrored.image[corners[0]], mirrored.image[corners[2]],
                           mirrored.image[corners[1]]);
  }
  mirrored.mesh = makeTriangleMesh(vertices, triangles);
  return mirrored;
}

namespace {

using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;
constexpr int kThreads = 1;

bool isOnWaterline(const MirroredMesh& mirrored, Index v) { return mirrored.image[v] == v; }

/// One for every vertex below the plane; none on the waterline, where odd jumps are 0.
Unknowns numberWet(const MirroredMesh& mirrored) {
  Unknowns unknowns;
  unknowns.of_vertex.assign(static_cast<std::size_t>(mirrored.mesh.vertexCount()), -1);
  for (Index v = 0; v < mirrored.image.size(); ++v)
    if (!isOnWaterline(mirrored, v)) unknowns.of_vertex[v] = unknowns.count++;
  return unknowns;
}

/// Numbers the unknowns of the wet part, and those of its images after them in the same order.
Unknowns numberBoth(const MirroredMesh& mirrored, const Unknowns& wet) {
  Unknowns both = wet;
  for (Index v = 0; v < mirrored.image.size(); ++v)
    if (!isOnWaterline(mirrored, v))
      both.of_vertex[mirrored.image[v]] = wet.count + wet.of_vertex[v];
  both.count = 2 * wet.count;
  return both;
}

/// W for odd jumps: of the wet part less that of its image, without its kernel.
Eigen::MatrixXd assembleOdd(const PanelSurface& surface, const MirroredMesh& mirrored,
                            const Unknowns& wet, const NearPanels& near) {
  const Index n = wet.count;
  const Eigen::MatrixXd W =
      assembleHypersingular(surface, numberBoth(mirrored, wet), near, kThreads);
  Eigen::MatrixXd odd = W.topLeftCorner(n, n) - W.bottomLeftCorner(n, n);
  fillKernel(surface, wet, odd);
  return odd;
}

/// mu at all vertices of the wet part and its image.
MatrixX6 solveOddJump(const PanelSurface& surface, const MirroredMesh& mirrored,
                      const NearPanels& near) {
  const Unknowns wet = numberWet(mirrored);
  const Eigen::LLT<Eigen::MatrixXd> factors(assembleOdd(surface, mirrored, wet, near));
  if (factors.info() != Eigen::Success)
    throw std::runtime_error(
        "the linear system is not positive definite; two sides of the surface are too close for "
        "the size of its panels");
  const MatrixX6 solution = factors.solve(-assembleNormalVelocity(surface, wet));
  MatrixX6 jump = MatrixX6::Zero(surface.vertexCount(), 6);
  for (Index v = 0; v < mirrored.image.size(); ++v) {
    if (isOnWaterline(mirrored, v)) continue;
    jump.row(v) = solution.row(wet.of_vertex[v]);
    jump.row(mirrored.image[v]) = -jump.row(v);
  }
  return jump;
}

}  // namespace

Matrix6 solveImageFlow(const TriangleMesh& body, int panels) {
  fixBlocksOfLargeProducts();
  const TriangleMesh coarse = wetPartOf(body);
  if (coarse.triangleCount() == 0) return Matrix6::Zero();
  const bool is_cut = (coarse.vertices.row(2).array() == 0).any();
  const TriangleMesh wet = refineSurface(coarse, is_cut, panels);
  const MirroredMesh mirrored = withImage(wet);
  const PanelSurface surface = makePanelSurface(mirrored.mesh, false);
  const NearPanels near = findNearPanels(surface, kThreads);
  const MatrixX6 jump = solveOddJump(surface, mirrored, near);
  const PanelMoments moments = computeExteriorMoments(surface, near, jump, kThreads);
  AMBIENT_ASSERT(jump.allFinite());
  Matrix6 K = Matrix6::Zero();
  for (Index t = 0; t < wet.triangleCount(); ++t) K += panelInertia(surface.panels[t], moments[t]);
  K = symmetricPart(K);
  return shiftOrigin(scaleShape(K, surface.length), -surface.centre);
}

namespace {

using Eigen::Matrix3d;

// Chosen on a cube, a box, a cylinder, an ellipsoid and a hull; the first ones for wedges.
const std::vector<double> kImmersions = {0.05, 0.1, 0.17, 0.28, 0.4, 0.55, 0.85, 1, 1.3, 2.2};

/// Makes the coarse surface that panels are cut from.
TriangleMesh coarseSurfaceOf(const FluidBody& body, int panels) {
  const TriangleMesh merged = mergeFlatTriangles(meshOf(body.surface), false, kMostDensePanels);
  return merged.triangleCount() > panels ? coarsened(merged, {0, panels, 0}) : merged;
}

/// Lowest and highest corner along a direction.
std::pair<double, double> extentOf(const TriangleMesh& mesh, const Vector3& direction) {
  double low = direction.dot(mesh.corner(0, 0)), high = low;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    for (int k = 0; k < 3; ++k) {
      const double along = direction.dot(mesh.corner(t, k));
      low = std::min(low, along);
      high = std::max(high, along);
    }
  return {low, high};
}

/// Compares a mesh of so many panels with the body's added mass: the roots of the ratios of the
/// diagonals, for what the panels are too coarse for. 1 where there is no added mass.
Vector6 panelFactors(const FluidBody& body, const TriangleMesh& mesh, int panels) {
  constexpr double kFar = 100, kNothing = 1e-6;  // sizes; of the largest entry of its kind
  const double size = mesh.extents().maxCoeff();
  const Vector6 coarse =
      solveImageFlow(mesh, {Vector3::UnitZ(), kFar * size, 1, 1}, panels).diagonal();
  const Vector6 exact = body.added_mass.diagonal();
  Vector6 factors = Vector6::Ones();
  for (int k = 0; k < 6; ++k) {
    const double least = kNothing * exact.segment<3>(k < 3 ? 0 : 3).maxCoeff();
    if (exact[k] > least && coarse[k] > least) factors[k] = std::sqrt(exact[k] / coarse[k]);
  }
  return factors;
}

[[noreturn]] void refuse(const FluidBody& body, const Vector3& normal, double immersion) {
  std::ostringstream text;
  text << "fluid body '" << body.name
       << "': the flow at the surface of the water has no solution on "
       << "this mesh where the body is about " << immersion
       << " of its height deep and the surface looks "
       << "along (" << normal.x() << ", " << normal.y() << ", " << normal.z()
       << "); build it without a waterline table, or from a mesh without long thin triangles";
  throw std::runtime_error(text.str());
}

/// Returns the body with the parts of its added mass alone, which its table corrects.
std::shared_ptr<const FluidBody> withoutTable(FluidBody body) {
  body.waterline = {};
  body.sphere_radius = 0;
  return std::make_shared<const FluidBody>(std::move(body));
}

class WaterlineSolver {
 public:
  WaterlineSolver(const FluidBody& body, int panels)
      : body_(body),
        panels_(panels),
        mesh_(coarseSurfaceOf(body, panels)),
        factors_(panelFactors(body, mesh_, panels)),
        hull_(body),
        by_parts_(makeWettedInertia(withoutTable(body))) {}

  /// Where the flow has no solution on the panels that the surface cuts, takes the correction at
  /// the next immersion that has one, 0.3 % of the height away at most.
  Matrix6 correction(const Vector3& normal, double immersion) const {
    for (const double shift : {0.0, 1e-3, -1e-3, 2e-3, -2e-3, 3e-3, -3e-3})
      if (const auto found = correctionAt(normal, immersion + shift)) return *found;
    refuse(body_, normal, immersion);
  }

 private:
  /// None: the flow has no solution.
  std::optional<Matrix6> correctionAt(const Vector3& normal, double immersion) const {
    Immersion at{{normal, 0, 1, 1}, 0, 0, {}};
    std::tie(at.low, at.high) = computeExtent(hull_, normal);
    at.plane.height = at.low + immersion * at.size();
    at.wet = computeWetVolume(hull_, at.plane);
    Matrix6 flow;
    try {
      flow = reference(normal, immersion, wetShare(at, body_.volume));
    } catch (const std::runtime_error&) {
      return std::nullopt;
    }
    if (!flow.allFinite()) return std::nullopt;
    return flow - by_parts_->unraisedInertia(at);
  }

  /// Panels are the finer the less of the body is wet.
  Matrix6 reference(const Vector3& normal, double immersion, double wet_share) const {
    const auto [low, high] = extentOf(mesh_, normal);
    const SurfacePlane plane{normal, low + immersion * (high - low), 1, 1};
    const Vector6 factors =
        factors_.unaryExpr([&](double x) { return portable::pow(x, wet_share); });
    return factors.asDiagonal() * solveImageFlow(mesh_, plane, panels_) * factors.asDiagonal();
  }

  const FluidBody& body_;
  int panels_;
  TriangleMesh mesh_;
  Vector6 factors_;
  PackedHull hull_;
  std::shared_ptr<const WettedInertia> by_parts_;
};

/// A node of the lattice whose flow is solved, and the turn that maps its direction to another's.
struct Origin {
  int node = -1;
  Matrix3d turn = Matrix3d::Identity();
};

/// Returns the symmetries that map a direction to itself.
std::vector<Matrix3d> keeping(const Vector3& direction, std::vector<Matrix3d> symmetries) {
  constexpr double kOff = 1e-6;
  const auto moves = [&](const Matrix3d& turn) {
    return (turn * direction - direction).norm() > kOff;
  };
  symmetries.erase(std::remove_if(symmetries.begin(), symmetries.end(), moves), symmetries.end());
  return symmetries;
}

/// The node in a direction; -1: none.
int nodeAt(const OctahedralLattice& lattice, const Vector3& direction) {
  constexpr double kSame = 1 - 1e-6;
  const OctahedralLattice::Corners place = lattice.cornersAround(direction);
  for (int corner = 0; corner < 3; ++corner)
    if (place.weight[corner] > kSame) return place.node[corner];
  return -1;
}

/// Finds the origin of every node: itself, or one that symmetries of the body map to it.
std::vector<Origin> findOrigins(const OctahedralLattice& lattice,
                                const std::vector<Matrix3d>& symmetries) {
  std::vector<Origin> origins(static_cast<std::size_t>(lattice.size()));
  std::vector<int> reached;
  for (int node = 0; node < lattice.size(); ++node) {
    if (origins[node].node >= 0) continue;
    origins[node].node = node;
    reached = {node};
    while (!reached.empty()) {
      const int from = reached.back();
      reached.pop_back();
      for (const Matrix3d& symmetry : symmetries) {
        const int to = nodeAt(lattice, symmetry * lattice.direction(from));
        if (to < 0 || origins[to].node >= 0) continue;
        origins[to] = {node, symmetry * origins[from].turn};
        reached.push_back(to);
      }
    }
  }
  return origins;
}

/// Counts solved immersions from any thread and tells of each attitude that it completes.
class AttitudeCount {
 public:
  AttitudeCount(const std::vector<Origin>& origins, const WaterlineSettings& settings)
      : progress_(settings.progress) {
    for (std::size_t node = 0; node < origins.size(); ++node)
      attitudes_ += origins[node].node == static_cast<int>(node) ? 1 : 0;
  }

  void addImmersion() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++immersions_;
    const auto count = static_cast<int>(kImmersions.size());
    if (progress_ && immersions_ % count == 0) progress_(immersions_ / count, attitudes_);
  }

 private:
  const std::function<void(int, int)>& progress_;
  int attitudes_ = 0;
  std::mutex mutex_;  // guards what follows
  int immersions_ = 0;
};

}  // namespace

Matrix6 solveImageFlow(const TriangleMesh& body, const SurfacePlane& plane, int panels) {
  Matrix3 axes;  // of a frame with z = 0 in the surface
  const PlaneAxes across(plane.normal);
  axes << across.first, across.second, plane.normal;
  const Vector3 origin = -plane.height * Vector3::UnitZ();
  TriangleMesh mesh = body;
  mesh.vertices = (axes.transpose() * mesh.vertices).colwise() + origin;
  return rotateAxes(shiftOrigin(solveImageFlow(mesh, panels), origin), axes);
}

WaterlineTable makeWaterlineTable(const FluidBody& body, const WaterlineSettings& settings) {
  const OctahedralLattice lattice(settings.subdivisions);
  const WaterlineSolver solver(body, settings.panels);
  const std::vector<Matrix3d> symmetries = findSymmetries(meshOf(body.surface), Vector3::Zero());
  const std::vector<Origin> origins = findOrigins(lattice, symmetries);
  const std::size_t count = kImmersions.size();
  AttitudeCount solved(origins, settings);

  WaterlineTable table{settings.subdivisions, kImmersions, {}};
  AMBIENT_ASSERT(origins.size() == static_cast<std::size_t>(lattice.size()));
  table.corrections.resize(origins.size() * count);
  const auto correctionOf = [&](std::ptrdiff_t i) -> Matrix6& {
    return table.corrections[static_cast<std::size_t>(i)];
  };
  const auto solve = [&](std::ptrdiff_t i) {
    const auto node = static_cast<int>(i / count);
    if (origins[node].node != node) return;
    const Vector3 normal = lattice.direction(node);
    correctionOf(i) =
        symmetrised(solver.correction(normal, kImmersions[i % count]), keeping(normal, symmetries));
    solved.addImmersion();
  };
  parallelFor(threadCount(settings.threads), table.corrections.size(), solve);
  for (std::size_t node = 0; node < origins.size(); ++node) {
    const Origin& origin = origins[node];
    if (origin.node == static_cast<int>(node)) continue;
    for (std::size_t k = 0; k < count; ++k)
      correctionOf(node * count + k) = turned(correctionOf(origin.node * count + k), origin.turn);
  }
  return table;
}

}  // namespace ambient
