#include "preprocess/resistance/stokes_resistance.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/numerics.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/panel.h"
#include "preprocess/potential_flow/surface/panel_surface.h"
#include "preprocess/potential_flow/surface/panel_views.h"
#include "preprocess/potential_flow/surface/shape_symmetry.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Limits of the distance of centroids over the sum of the radii.
constexpr double kTouching = 1.1816;  // 2/3 sqrt(pi): up to here sixteen points
constexpr double kNear = 3;           // six points
constexpr double kFar = 8;  // three points, beyond one; kNear for groups of several panels

/// Exact to degree 2.
constexpr std::array<TriangleNode, 3> kTriangleRule3{{{{2.0 / 3, 1.0 / 6, 1.0 / 6}, 1.0 / 3},
                                                      {{1.0 / 6, 2.0 / 3, 1.0 / 6}, 1.0 / 3},
                                                      {{1.0 / 6, 1.0 / 6, 2.0 / 3}, 1.0 / 3}}};

/// Panels with one force per area, and their extent.
struct Group {
  std::vector<std::size_t> members;
  Vector3d centroid = Vector3d::Zero();
  double area = 0, radius = 0;
};

template <class Place>
bool isWithin(double limit, const Panel& a, const Place& b) {
  const double reach = limit * (a.radius + b.radius);
  return (a.centroid - b.centroid).squaredNorm() < reach * reach;
}

std::vector<Group> groupsOf(const std::vector<Panel>& panels, const std::vector<int>& group,
                            int count) {
  std::vector<Group> groups(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < panels.size(); ++t) {
    AMBIENT_ASSERT(group[t] >= 0 && group[t] < count);
    Group& of_panel = groups[static_cast<std::size_t>(group[t])];
    of_panel.members.push_back(t);
    of_panel.area += panels[t].area;
    of_panel.centroid += panels[t].area * panels[t].centroid;
  }
  for (Group& g : groups) {
    g.centroid /= g.area;
    for (const std::size_t t : g.members)
      g.radius = std::max(g.radius, (panels[t].centroid - g.centroid).norm() + panels[t].radius);
  }
  return groups;
}

/// Symmetric 3 x 3 blocks, by the components of PanelTensors.
using Blocks = std::vector<Vector6>;

/// Points that see one panel, at most sixteen, and the groups that their tensors count for.
class PointBlock {
 public:
  PointBlock(const Panel& source, Blocks& rows) : source_(numbersOf(source)), rows_(rows) {}

  /// Adds a point of a group with its weight, and evaluates a full block.
  void add(std::size_t group, const Vector3d& point, double weight) {
    for (int axis = 0; axis < 3; ++axis) points_.at[axis][count_] = point[axis];
    group_[count_] = group;
    weight_[count_] = weight;
    if (++count_ == kMostPanelPoints) flush();
  }

  /// Adds the points of a rule on a panel of a group.
  template <std::size_t N>
  void add(std::size_t group, const Panel& panel, const std::array<TriangleNode, N>& rule) {
    for (const TriangleNode& node : rule)
      add(group, panel.at(node.barycentric), panel.area * node.weight);
  }

  /// Evaluates what is left.
  void flush() {
    static const auto view = kViewStokeslets.fastest();
    if (count_ == 0) return;
    for (auto& axis : points_.at) std::fill(axis + count_, std::end(axis), axis[0]);
    view(source_, points_, count_ <= 8 ? 8 : kMostPanelPoints, tensors_);
    for (std::size_t i = 0; i < count_; ++i)
      for (int c = 0; c < 6; ++c) rows_[group_[i]][c] += weight_[i] * tensors_.at[c][i];
    count_ = 0;
  }

 private:
  PanelNumbers source_;
  Blocks& rows_;
  PanelPoints points_;
  PanelTensors tensors_;
  std::array<std::size_t, kMostPanelPoints> group_{};
  std::array<double, kMostPanelPoints> weight_{};
  std::size_t count_ = 0;
};

/// Whether the integral of a pair has its points on the first group and the closed form on the
/// second one: on the smaller one if they differ clearly, so that rounding does not decide.
bool hasPoints(std::size_t first, std::size_t second, const std::vector<Group>& groups) {
  constexpr double kClearlySmaller = 0.7937;
  const double a = groups[first].radius, b = groups[second].radius;
  if (a < kClearlySmaller * b || b < kClearlySmaller * a) return a < b;
  return first <= second;
}

/// Adds int_G int_S of the groups G that have points and one panel S of a group.
void addIntegrals(const Panel& source, std::size_t of, const std::vector<Panel>& panels,
                  const std::vector<Group>& groups, Blocks& rows) {
  PointBlock block(source, rows);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!hasPoints(g, of, groups)) continue;
    const double far = groups[g].members.size() > 1 ? kNear : kFar;
    if (!isWithin(far, source, groups[g])) {
      block.add(g, groups[g].centroid, groups[g].area);
      continue;
    }
    for (const std::size_t t : groups[g].members) {
      const Panel& panel = panels[t];
      if (isWithin(kTouching, source, panel))
        block.add(g, panel, kTriangleRule16);
      else if (isWithin(kNear, source, panel))
        block.add(g, panel, kTriangleRule6);
      else if (isWithin(far, source, panel))
        block.add(g, panel, kTriangleRule3);
      else
        block.add(g, panel.centroid, panel.area);
    }
  }
  block.flush();
}

}  // namespace

Eigen::MatrixXd assembleStokesMatrix(const std::vector<Panel>& panels,
                                     const std::vector<int>& group, int count, int threads) {
  AMBIENT_ASSERT(group.size() == panels.size() && count > 0);
  const std::vector<Group> groups = groupsOf(panels, group, count);
  const Index size = 3 * static_cast<Index>(count);
  Eigen::MatrixXd A(size, size);
  parallelFor(threads, count, [&](std::ptrdiff_t column) {
    const auto of = static_cast<std::size_t>(column);
    Blocks rows(groups.size(), Vector6::Zero());
    for (const std::size_t s : groups[of].members)
      addIntegrals(panels[s], of, panels, groups, rows);
    rows[of] /= 2;
    for (std::size_t g = 0; g < rows.size(); ++g) {
      const Vector6& b = rows[g];
      A.block<3, 3>(3 * static_cast<Index>(g), 3 * column) << b[0], b[3], b[4], b[3], b[1], b[5],
          b[4], b[5], b[2];
    }
  });
  for (Index j = 0; j < size; ++j)
    for (Index i = 0; i <= j; ++i) A(i, j) = A(j, i) = A(i, j) + A(j, i);
  return A;
}

namespace {

using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr double kMostTriangles =
    1.5;  // over the number of panels aimed at: so many are taken as they are

/// Panels of a surface and what stands for one unknown force.
struct PanelGroups {
  PanelSurface surface;
  std::vector<int> group;  ///< of each panel
  int count = 0;
};

/// Places of panels as points of a space in which neighbours are alike in place and normal:
/// centroid and normal, one column per panel. Lengths over the size of the body.
Eigen::Matrix<double, 6, Eigen::Dynamic> placesOf(const PanelSurface& surface) {
  constexpr double kNormalWeight = 0.5;  // a turn by a right angle counts as 0.7 of the size
  Eigen::Matrix<double, 6, Eigen::Dynamic> places(6, surface.panelCount());
  for (Index t = 0; t < surface.panelCount(); ++t)
    places.col(t) << surface.panels[t].centroid, kNormalWeight * surface.panels[t].normal;
  return places;
}

/// Halves the panels [first, last) of `order` across the longest extent of their places until there
/// are `parts`.
void halve(const Eigen::Matrix<double, 6, Eigen::Dynamic>& places, std::vector<int>& order,
           std::size_t first, std::size_t last, int parts, PanelGroups& groups) {
  if (parts <= 1 || last - first <= 1) {
    for (std::size_t i = first; i < last; ++i) groups.group[order[i]] = groups.count;
    ++groups.count;
    return;
  }
  Vector6 low = places.col(order[first]), high = low;
  for (std::size_t i = first; i < last; ++i) {
    low = low.cwiseMin(places.col(order[i]));
    high = high.cwiseMax(places.col(order[i]));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::sort(order.begin() + first, order.begin() + last, [&](int a, int b) {
    return std::pair(places(axis, a), a) < std::pair(places(axis, b), b);
  });
  const std::size_t middle = first + (last - first) * (parts / 2) / parts;
  halve(places, order, first, middle, parts / 2, groups);
  halve(places, order, middle, last, parts - parts / 2, groups);
}

/// Each panel alone, or if there are many more than asked for, groups of panels.
PanelGroups groupsOf(const TriangleMesh& mesh, const StokesSettings& settings) {
  PanelGroups groups{makePanelSurface(mesh, settings.sheet), {}, 0};
  const auto panels = static_cast<std::size_t>(groups.surface.panelCount());
  groups.group.resize(panels);
  std::vector<int> order(panels);
  std::iota(order.begin(), order.end(), 0);
  if (static_cast<double>(panels) <= kMostTriangles * settings.panels) {
    groups.group = order;
    groups.count = static_cast<int>(panels);
    return groups;
  }
  halve(placesOf(groups.surface), order, 0, panels, settings.panels, groups);
  return groups;
}

/// A fine closed mesh in fewer triangles: as many as asked for, or so many that its parts are not
/// lost.
TriangleMesh inPanels(const TriangleMesh& mesh, int panels) {
  constexpr int kMostPanels = 3000;
  for (int triangles = panels; triangles <= kMostPanels; triangles *= 3) {
    if (static_cast<double>(mesh.triangleCount()) <= kMostTriangles * triangles) return mesh;
    if (auto fewer = inFewerTriangles(mesh, triangles)) return *std::move(fewer);
  }
  if (mesh.triangleCount() <= kMostPanels) return mesh;
  return withVolume(coarsened(mesh, {kMostPanels, kMostPanels, 0}),
                    computeMassProperties(mesh).volume);
}

/// Panels of a surface, and larger ones to extrapolate from where it has edges.
SurfaceLevels panelsOf(const TriangleMesh& mesh, const StokesSettings& settings) {
  const int most = static_cast<int>(kMostTriangles * settings.panels);
  const TriangleMesh merged = mergeFlatTriangles(mesh, settings.sheet, most);
  if (merged.triangleCount() > most && !settings.sheet)
    return {undivided(inPanels(mesh, settings.panels)), {}, {}};
  if (!settings.sheet && areSmooth(estimateBulges(mesh))) return {undivided(mesh), {}, {}};
  return refineInLevels(merged, settings.sheet, most);
}

/// Adds the pressures inside of closed surfaces, which move nothing, to the kernel's eigenvalues 0.
/// Parts that share a group have one pressure.
void fillPressures(const PanelGroups& groups, Eigen::MatrixXd& A) {
  const PanelSurface& surface = groups.surface;
  const auto partOf = [&](Index t) { return surface.component[surface.triangles(0, t)]; };
  std::vector<int> first(static_cast<std::size_t>(groups.count), -1);  // part of each group
  DisjointSets parts(static_cast<std::size_t>(surface.component_count));
  for (Index t = 0; t < surface.panelCount(); ++t) {
    int& part = first[groups.group[t]];
    if (part >= 0) parts.join(part, partOf(t));
    part = partOf(t);
  }
  std::map<int, Eigen::VectorXd> pressures;
  for (Index t = 0; t < surface.panelCount(); ++t) {
    Eigen::VectorXd& z =
        pressures.try_emplace(parts.find(partOf(t)), Eigen::VectorXd::Zero(A.rows())).first->second;
    z.segment<3>(3 * groups.group[t]) += surface.panels[t].area * surface.panels[t].normal;
  }
  const double mean = A.trace() / static_cast<double>(A.rows());
  for (const auto& [part, z] : pressures)
    if (const double square = z.squaredNorm(); square > 0) A += (mean / square) * z * z.transpose();
}

/// Solves A x = B for A^(-1/2) B. Where quadrature leaves A a negative eigenvalue, as of panels far
/// larger than the gap to what they face, its diagonal grows by as little as it takes.
MatrixX6 halfSolution(const Eigen::MatrixXd& A, const MatrixX6& B) {
  constexpr double kLeast = 1e-6, kMost = 0.1;
  double growth = 0;
  do {
    Eigen::MatrixXd factored = A;
    factored.diagonal() *= 1 + growth;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(factored);
    if (factors.info() == Eigen::Success) return factors.matrixL().solve(B);
    growth = std::max(kLeast, 4 * growth);
  } while (growth < kMost);
  throw std::runtime_error(
      "creeping flow: the linear system of " + std::to_string(A.rows() / 3) +
      " panels is not positive definite; two sides of the surface are too close for the size "
      "of its triangles: use more triangles, a sheet, or build --wrap");
}

/// int h g_j of eq. (93): velocities of the six unit motions, per group.
MatrixX6 motionsOf(const PanelGroups& groups) {
  MatrixX6 B = MatrixX6::Zero(3 * static_cast<Index>(groups.count), 6);
  for (Index t = 0; t < groups.surface.panelCount(); ++t) {
    const Panel& panel = groups.surface.panels[t];
    auto rows = B.middleRows<3>(3 * groups.group[t]);
    rows.leftCols<3>() -= panel.area * crossMatrix(panel.centroid);
    rows.rightCols<3>().diagonal().array() += panel.area;
  }
  return B;
}

/// R about the surface's centre, in the units of the solver.
Matrix6 solveUnitFlow(const PanelGroups& groups, const StokesSettings& settings) {
  fixBlocksOfLargeProducts();
  Eigen::MatrixXd A = assembleStokesMatrix(groups.surface.panels, groups.group, groups.count,
                                           threadCount(settings.threads));
  if (!settings.sheet) fillPressures(groups, A);
  const MatrixX6 half = halfSolution(A, motionsOf(groups));
  const Matrix6 R = 8 * kPi * half.transpose() * half;
  return (R + R.transpose()) / 2;
}

/// R about the mesh's origin, on the triangles of a mesh.
Matrix6 solveOnPanels(const TriangleMesh& panels, const StokesSettings& settings) {
  const PanelGroups groups = groupsOf(panels, settings);
  const Matrix6 R = scaleResistance(solveUnitFlow(groups, settings), groups.surface.length);
  return shiftOrigin(R, -groups.surface.centre);
}

/// To panels of no size: the forces at edges go to infinity, and with them the error goes with the
/// size of panels to the power of 1.1 (cube, 12 to 480 panels).
Matrix6 extrapolated(const Matrix6& fine, const Matrix6& coarse, double ratio) {
  constexpr double kOrder = 1.1;
  return fine + (fine - coarse) / (portable::pow(ratio, kOrder / 2) - 1);
}

}  // namespace

Matrix6 computeStokesResistance(const TriangleMesh& mesh, const StokesSettings& settings) {
  if (mesh.triangleCount() == 0)
    throw std::runtime_error("creeping flow: the mesh has 0 triangles; it needs at least 1");
  AMBIENT_ASSERT(settings.panels > 0);
  const SurfaceLevels levels = panelsOf(mesh, settings);
  Matrix6 R = solveOnPanels(levels.fine.mesh, settings);
  if (levels.coarse) {
    const auto fine = static_cast<double>(levels.fine.mesh.triangleCount());
    const auto coarse = static_cast<double>(levels.coarse->triangleCount());
    R = extrapolated(R, solveOnPanels(*levels.coarse, settings), fine / coarse);
  }
  return withSymmetriesOf(mesh, settings.sheet, R, scaleResistance);
}

Vector6 ellipsoidResistance(const Vector3& semi_axes) {
  AMBIENT_ASSERT(semi_axes.allFinite() && semi_axes.minCoeff() >= 0);
  const double size = semi_axes.maxCoeff();
  const Vector3 squares = (semi_axes / size).cwiseAbs2();
  AMBIENT_ASSERT((squares.array() > 0).count() >= 2);
  Vector3 alpha = Vector3::Zero();  // a_i^2 alpha_i, 0 of a thin axis
  for (int i = 0; i < 3; ++i)
    if (squares[i] > 0)
      alpha[i] = 2.0 / 3 * squares[i] *
                 integralD({squares[(i + 1) % 3], squares[(i + 2) % 3], squares[i]});
  Vector6 R;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    R[i] = 16 * kPi / 3 * (squares[j] + squares[k]) / (alpha[j] + alpha[k]) * size * size * size;
    R[3 + i] = 16 * kPi / (alpha.sum() + alpha[i]) * size;
  }
  return R;
}

Vector6 sphereResistance(double radius) {
  AMBIENT_ASSERT(radius > 0);
  Vector6 R;
  R << Vector3::Constant(8 * kPi * radius * radius * radius), Vector3::Constant(6 * kPi * radius);
  return R;
}

Vector3 centreOfReaction(const Matrix6& resistance) {
  const Eigen::Matrix3d T = resistance.bottomRightCorner<3, 3>(),
                        K = resistance.bottomLeftCorner<3, 3>();
  const Vector3d twice(K(2, 1) - K(1, 2), K(0, 2) - K(2, 0), K(1, 0) - K(0, 1));
  const Eigen::Matrix3d change = T.trace() * Eigen::Matrix3d::Identity() - T;
  return -change.inverse() * twice;
}

}  // namespace ambient
