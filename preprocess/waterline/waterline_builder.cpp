#include "preprocess/waterline/waterline_builder.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/surface/wetted_parts.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/shape_symmetry.h"
#include "preprocess/waterline/image_flow.h"

namespace ambient {
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

class WaterlineSolver {
 public:
  WaterlineSolver(const FluidBody& body, int panels)
      : body_(body),
        panels_(panels),
        mesh_(coarseSurfaceOf(body, panels)),
        factors_(panelFactors(body, mesh_, panels)),
        hull_(body),
        parts_(body, std::make_shared<AddedMassParts>(body.added_mass_parts)) {}

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
    return flow - parts_.unraisedInertia(at);
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
  WettedParts parts_;
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
  const OctahedralLattice::Place place = lattice.placeOf(direction);
  for (int corner = 0; corner < 3; ++corner)
    if (place.share[corner] > kSame) return place.node[corner];
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
