#include "preprocess/potential_flow/solvers/flow_solver.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/numerics.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/solvers/block_product.h"
#include "preprocess/potential_flow/surface/panel.h"
#include "preprocess/potential_flow/surface/panel_pair.h"

namespace ambient {

using Eigen::Index;
using Eigen::MatrixXf;

PairIntegrals::PairIntegrals(const PanelTree& tree, const ClusterPairs& pairs, int degree,
                             int threads)
    : tree_(tree),
      pairs_(pairs),
      expansions_(tree, pairs, degree, threads),
      threads_(threads),
      panel_harmonics_(expansions_.harmonics().count(), tree.surface.panelCount()),
      offset_(pairs.near.size()) {
  struct Task {
    int t, s;
  };
  std::vector<Task> tasks;
  std::size_t size = 0;
  for (std::size_t t = 0; t < offset_.size(); ++t)
    for (const int s : pairs.near[t]) {
      offset_[t].push_back(size);
      if (s < static_cast<int>(t)) continue;
      size += leaf(static_cast<int>(t)).count * leaf(s).count;
      tasks.push_back({static_cast<int>(t), s});
    }
  near_.resize(size);
  parallelFor(threads, static_cast<Index>(tasks.size()),
              [&](Index k) { fillNear(tasks[k].t, tasks[k].s); });
  parallelFor(threads, static_cast<Index>(offset_.size()),
              [&](Index k) { fillLeafHarmonics(static_cast<int>(k)); });
}

double PairIntegrals::nearBytes(const PanelTree& tree, const ClusterPairs& pairs) {
  double numbers = 0;
  for (std::size_t t = 0; t < pairs.near.size(); ++t)
    for (const int s : pairs.near[t])
      if (s >= static_cast<int>(t))
        numbers += static_cast<double>(tree.clusters[tree.leaves[t]].count) *
                   static_cast<double>(tree.clusters[tree.leaves[s]].count);
  return sizeof(float) * numbers;
}

void PairIntegrals::fillNear(int t, int s) {
  const PanelCluster &rows = leaf(t), &columns = leaf(s);
  float* value = near_.data() + nearOffset(t, s);
  Eigen::ArrayXd far(rows.count);
  for (Index j = 0; j < columns.count; ++j, value += rows.count) {
    const Index source = columns.first + j;
    computeFarPairIntegrals(tree_.surface.arrays, source, rows.first, far);
    const Index upper = t == s ? j + 1 : rows.count;
    for (Index i = 0; i < upper; ++i) {
      const Index target = rows.first + i;
      const bool is_far = classifyPair(tree_.surface, target, source) == PairKind::Far;
      value[i] =
          static_cast<float>(is_far ? far[i] : computePairIntegral(tree_.surface, target, source));
    }
  }
  if (t != s) return;
  Eigen::Map<MatrixXf> own(near_.data() + nearOffset(t, t), rows.count, rows.count);
  own.triangularView<Eigen::StrictlyLower>() = own.transpose();
}

void PairIntegrals::fillLeafHarmonics(int k) {
  const PanelCluster& cluster = leaf(k);
  Eigen::VectorXd at_node(expansions_.harmonics().count()), mean(at_node.size());
  for (Index t = cluster.first; t < cluster.first + cluster.count; ++t) {
    const Panel& panel = tree_.surface.panels[t];
    mean.setZero();
    for (const TriangleNode& node : kTriangleRule6) {
      expansions_.harmonics().evaluateRegular(
          (panel.at(node.barycentric) - cluster.centre) / cluster.radius, at_node);
      mean += node.weight * at_node;
    }
    panel_harmonics_.col(t) = (panel.area * mean).cast<float>();
  }
}

std::size_t PairIntegrals::nearOffset(int t, int s) const {
  const std::vector<int>& near = pairs_.near[t];
  return offset_[t][std::lower_bound(near.begin(), near.end(), s) - near.begin()];
}

PairIntegrals::Block PairIntegrals::nearBlock(int t, int s) const {
  return {near_.data() + nearOffset(t, s), leaf(t).count, leaf(s).count};
}

double PairIntegrals::entry(Index t, Index s) const {
  AMBIENT_ASSERT(t >= 0 && s >= 0 &&
                 std::max(t, s) < static_cast<Index>(tree_.leaf_of_panel.size()));
  if (tree_.leaf_of_panel[t] > tree_.leaf_of_panel[s]) std::swap(t, s);
  const int row = tree_.leaf_of_panel[t], column = tree_.leaf_of_panel[s];
  return nearBlock(row, column)(t - leaf(row).first, s - leaf(column).first);
}

void PairIntegrals::addNear(int t, int s, const FieldRows& x, FieldRows& y) const {
  const Block block = t <= s ? nearBlock(t, s) : nearBlock(s, t);
  const Index stride = block.outerStride();
  const MatrixBlock view = t <= s
                               ? MatrixBlock{block.data(), block.rows(), block.cols(), 1, stride}
                               : MatrixBlock{block.data(), block.cols(), block.rows(), stride, 1};
  addBlockProduct(view, x.row(leaf(s).first).data(), static_cast<int>(x.cols()), y.data());
}

MatrixXf PairIntegrals::apply(const MatrixXf& x) const {
  const Index fields = x.cols(), terms = panel_harmonics_.rows();
  const auto leaves = static_cast<Index>(tree_.leaves.size());
  MatrixXf multipoles(terms, fields * static_cast<Index>(tree_.clusters.size())), locals;
  FieldRows rows = FieldRows::Zero(x.rows(), fields <= kFieldGroup ? kFieldGroup : 3 * kFieldGroup);
  parallelFor(threads_, leaves, [&](Index k) {
    const PanelCluster& c = leaf(static_cast<int>(k));
    multipoles.middleCols(tree_.leaves[k] * fields, fields).noalias() =
        panel_harmonics_.middleCols(c.first, c.count) * x.middleRows(c.first, c.count);
    rows.block(c.first, 0, c.count, fields) = x.middleRows(c.first, c.count);
  });
  expansions_.computeLocals(multipoles, fields, locals);
  MatrixXf y(x.rows(), fields);
  parallelFor(threads_, leaves, [&](Index k) {
    const PanelCluster& c = leaf(static_cast<int>(k));
    FieldRows near = FieldRows::Zero(c.count, rows.cols());
    for (const int s : pairs_.near[k]) addNear(static_cast<int>(k), s, rows, near);
    auto part = y.middleRows(c.first, c.count);
    part.noalias() = panel_harmonics_.middleCols(c.first, c.count).transpose() *
                     locals.middleCols(tree_.leaves[k] * fields, fields);
    part += near.leftCols(fields);
  });
  return y;
}

double memoryLimit(double setting) {
  if (setting > 0) return setting;
  // Reads the memory that Linux can give without swapping; elsewhere all that is installed counts.
  std::ifstream info("/proc/meminfo");
  std::string key;
  for (double kilobytes = 0; info >> key >> kilobytes;
       info.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
    if (key == "MemAvailable:") return 1024 * kilobytes;
  const double pages = static_cast<double>(::sysconf(_SC_PHYS_PAGES));
  return pages > 0 ? pages * static_cast<double>(::sysconf(_SC_PAGESIZE))
                   : std::numeric_limits<double>::infinity();
}

void requireMemory(Eigen::Index panels, double bytes, double limit) {
  if (bytes <= limit) return;
  std::ostringstream message;
  message.precision(2);
  message << "potential flow: " << panels << " panels need " << bytes / 1e9
          << " GB of memory, more than the " << limit / 1e9
          << " GB that may be used: use fewer panels or allow more memory";
  throw std::runtime_error(message.str());
}

void raiseOutOfMemory(Eigen::Index panels, double bytes) {
  std::ostringstream message;
  message.precision(2);
  message << "potential flow: " << panels << " panels need ";
  if (bytes > 0) {
    message << bytes / 1e9 << " GB of memory, which is not there: use fewer panels";
  } else {
    message << "more memory than there is: use fewer panels";
  }
  throw std::runtime_error(message.str());
}

namespace {

using Eigen::Vector3d;
using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;
using RowVector6 = Eigen::Matrix<double, 1, 6>;

constexpr double kResidualLimit = 1e-6;  // of the residual, in the norm of the preconditioner
constexpr int kMostIterations = 500;
constexpr Index kAtOnce = 512;  // unknowns or panels of one task

/// Calls body(i) for all i, in tasks of many.
template <typename Body>
void forEach(int threads, Index count, const Body& body) {
  parallelFor(threads, (count + kAtOnce - 1) / kAtOnce, [&](Index task) {
    for (Index i = task * kAtOnce; i < std::min(count, (task + 1) * kAtOnce); ++i) body(i);
  });
}

/// The panels at every unknown, and which of their corners it is.
struct Corners {
  struct Entry {
    int panel, corner;
  };
  std::vector<std::size_t> first;  ///< of every unknown, and the end
  std::vector<Entry> entries;
};

Corners listCorners(const PanelSurface& surface, const Unknowns& unknowns) {
  Corners corners;
  corners.first.assign(unknowns.count + 1, 0);
  const auto forAll = [&](const auto& body) {
    for (Index t = 0; t < surface.panelCount(); ++t)
      for (int a = 0; a < 3; ++a) {
        const int i = unknowns.of_vertex[surface.triangles(a, t)];
        if (i >= 0) body(i, Corners::Entry{static_cast<int>(t), a});
      }
  };
  forAll([&](int i, const Corners::Entry&) { ++corners.first[i + 1]; });
  for (int i = 0; i < unknowns.count; ++i) corners.first[i + 1] += corners.first[i];
  corners.entries.resize(corners.first.back());
  std::vector<std::size_t> next = corners.first;
  forAll([&](int i, const Corners::Entry& entry) { corners.entries[next[i]++] = entry; });
  return corners;
}

/// W and its preconditioner.
class HypersingularSystem {
 public:
  HypersingularSystem(const PanelSurface& surface, const Unknowns& unknowns,
                      const PairIntegrals& integrals, int threads)
      : surface_(surface),
        unknowns_(unknowns),
        integrals_(integrals),
        threads_(threads),
        corners_(listCorners(surface, unknowns)),
        mass_(unknowns.count),
        diagonal_(unknowns.count) {
    forEach(threads, unknowns.count, [&](Index i) { fillDiagonals(i); });
    listClosedComponents();
  }

  MatrixX6 apply(const MatrixX6& x) const {
    MatrixXf curl(surface_.panelCount(), 18);
    forEach(threads_, surface_.panelCount(), [&](Index t) {
      Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
      for (int a = 0; a < 3; ++a)
        if (const int j = unknownAt(t, a); j >= 0) sum += surface_.panels[t].hatCurl(a) * x.row(j);
      for (int k = 0; k < 18; ++k) curl(t, k) = static_cast<float>(sum.data()[k]);
    });
    const MatrixXf potential = integrals_.apply(curl);
    MatrixX6 y(x.rows(), 6);
    forEach(threads_, unknowns_.count, [&](Index i) {
      RowVector6 sum = RowVector6::Zero();
      forCorners(i, [&](int t, int a) {
        Eigen::Matrix<double, 3, 6> value;
        for (int k = 0; k < 18; ++k) value.data()[k] = potential(t, k);
        sum += surface_.panels[t].hatCurl(a).transpose() * value;
      });
      y.row(i) = sum / (4 * kPi);
    });
    return y;
  }

  /// An approximate solution of W z = r: four times the single layer between divisions by the
  /// masses of the hat functions, which smooth parts need, and the diagonal, which rough ones do.
  MatrixX6 precondition(const MatrixX6& r) const {
    MatrixXf density(surface_.panelCount(), 6);
    forEach(threads_, surface_.panelCount(), [&](Index t) {
      RowVector6 sum = RowVector6::Zero();
      for (int a = 0; a < 3; ++a)
        if (const int j = unknownAt(t, a); j >= 0) sum += r.row(j) / mass_[j];
      density.row(t) = (sum / 3).cast<float>();
    });
    const MatrixXf potential = integrals_.apply(density);
    MatrixX6 z(r.rows(), 6);
    forEach(threads_, unknowns_.count, [&](Index i) {
      RowVector6 sum = RowVector6::Zero();
      forCorners(i, [&](int t, int) { sum += potential.row(t).cast<double>() / 3; });
      z.row(i) = sum / (kPi * mass_[i]) + r.row(i) / diagonal_[i];
    });
    removeConstants(z);
    return z;
  }

  /// Makes the mean over every closed component 0: its constants are the kernel of W.
  void removeConstants(MatrixX6& x) const {
    for (const std::vector<int>& members : closed_) {
      RowVector6 mean = RowVector6::Zero();
      for (const int i : members) mean += x.row(i);
      mean /= static_cast<double>(members.size());
      for (const int i : members) x.row(i) -= mean;
    }
  }

 private:
  int unknownAt(Index t, int corner) const {
    return unknowns_.of_vertex[surface_.triangles(corner, t)];
  }

  template <typename Body>
  void forCorners(Index i, const Body& body) const {
    for (std::size_t k = corners_.first[i]; k < corners_.first[i + 1]; ++k)
      body(corners_.entries[k].panel, corners_.entries[k].corner);
  }

  void fillDiagonals(Index i) {
    double mass = 0, diagonal = 0;
    forCorners(i, [&](int t, int a) {
      mass += surface_.panels[t].area / 3;
      const Vector3d curl = surface_.panels[t].hatCurl(a);
      forCorners(i, [&](int s, int b) {
        diagonal += curl.dot(surface_.panels[s].hatCurl(b)) * integrals_.entry(t, s);
      });
    });
    mass_[i] = mass;
    AMBIENT_ASSERT(mass > 0 && diagonal > 0);
    diagonal_[i] = diagonal / (4 * kPi);
  }

  void listClosedComponents() {
    std::vector<bool> open(surface_.component_count, false);
    std::vector<std::vector<int>> members(surface_.component_count);
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      if (surface_.boundary_vertex[v]) open[surface_.component[v]] = true;
      if (unknowns_.of_vertex[v] >= 0)
        members[surface_.component[v]].push_back(unknowns_.of_vertex[v]);
    }
    for (int c = 0; c < surface_.component_count; ++c)
      if (!open[c]) closed_.push_back(std::move(members[c]));
  }

  const PanelSurface& surface_;
  const Unknowns& unknowns_;
  const PairIntegrals& integrals_;
  int threads_;
  Corners corners_;
  Eigen::VectorXd mass_, diagonal_;
  std::vector<std::vector<int>> closed_;  ///< unknowns of every closed component
};

RowVector6 columnProducts(const MatrixX6& a, const MatrixX6& b) {
  return a.cwiseProduct(b).colwise().sum();
}

[[noreturn]] void raiseNotConverged(int unknowns, int iterations) {
  throw std::runtime_error(
      "potential flow: the linear system of " + std::to_string(unknowns) +
      " vertices was not solved within " + std::to_string(iterations) +
      " iterations; two sides of the surface are too close for the size of its triangles: use more "
      "triangles, a sheet, or build --wrap");
}

/// Solves W mu = -B without the matrix W, by conjugate gradients, all six motions side by side.
/// Preconditioner: the single layer, whose product with W is about a fourth of unity;
/// docs/theory.md eq. (34). The same bits for every number of threads. The mean is 0 on closed
/// components.
/// @throws std::runtime_error if they do not converge.
Jump solveIteratively(const PanelSurface& surface, const Unknowns& unknowns,
                      const PairIntegrals& integrals, int threads) {
  AMBIENT_ASSERT(unknowns.of_vertex.size() == static_cast<std::size_t>(surface.vertexCount()));
  const HypersingularSystem system(surface, unknowns, integrals, threads);
  MatrixX6 jump = MatrixX6::Zero(unknowns.count, 6);
  MatrixX6 residual = -assembleNormalVelocity(surface, unknowns);
  system.removeConstants(residual);
  MatrixX6 z = system.precondition(residual);
  MatrixX6 direction = z;
  RowVector6 square = columnProducts(residual, z);
  const RowVector6 limit = kResidualLimit * kResidualLimit * square;
  for (int iterations = 0; iterations < kMostIterations; ++iterations) {
    if ((square.array() <= limit.array()).all()) return {atVertices(unknowns, jump), iterations};
    const MatrixX6 image = system.apply(direction);
    const RowVector6 curvature = columnProducts(direction, image);
    RowVector6 step = RowVector6::Zero();
    for (int k = 0; k < 6; ++k) {
      if (square[k] <= limit[k]) continue;
      if (!(curvature[k] > 0)) raiseNotConverged(unknowns.count, iterations);
      step[k] = square[k] / curvature[k];
    }
    jump += direction * step.asDiagonal();
    residual -= image * step.asDiagonal();
    system.removeConstants(residual);
    z = system.precondition(residual);
    const RowVector6 next = columnProducts(residual, z);
    for (int k = 0; k < 6; ++k) {
      const double ratio = step[k] > 0 ? next[k] / square[k] : 0;
      direction.col(k) = z.col(k) + ratio * direction.col(k);
    }
    square = next;
  }
  raiseNotConverged(unknowns.count, kMostIterations);
}

// The energy, quadratic in the jump, comes out within 1e-5. The rotation block is linear in the
// double layer, of whose two sides a thin body leaves little: a degree of 5 would leave 1e-4 of it.
constexpr int kLeafSize = 64;
constexpr int kDegree = 5;
constexpr int kDoubleLayerDegree = 8;
constexpr double kOpening = 0.7;
// Of geometry, tree, fields and moments, measured; of what kernels read of both orders of panels.
constexpr double kBytesPerPanel = 2000 + 2 * (sizeof(PanelNumbers) + sizeof(PanelNodes));

}  // namespace

HierarchicalSolver::HierarchicalSolver(const PanelSurface& surface, int threads,
                                       double memory_limit)
    : threads_(threads),
      tree_(makePanelTree(surface, kLeafSize)),
      pairs_(pairClusters(tree_, kOpening)) {
  requireMemory(surface.panelCount(), bytesNeeded(), memory_limit);
  fixBlocksOfLargeProducts();
}

double HierarchicalSolver::bytesNeeded() const {
  constexpr int kFields = 18, kTerms = (kDegree + 1) * (kDegree + 1);
  const double expansions =
      2.0 * sizeof(float) * kFields * kTerms * static_cast<double>(tree_.clusters.size());
  return PairIntegrals::nearBytes(tree_, pairs_) + expansions +
         kBytesPerPanel * static_cast<double>(tree_.surface.panelCount());
}

Jump HierarchicalSolver::solveJump(const Unknowns& unknowns) {
  const PairIntegrals integrals(tree_, pairs_, kDegree, threads_);
  return solveIteratively(tree_.surface, unknowns, integrals, threads_);
}

PanelMoments HierarchicalSolver::computeMoments(const Jump& jump) {
  return computeExteriorMoments(tree_, pairs_, kDoubleLayerDegree, jump.values, threads_);
}

namespace {

void addBlockProductBaseline(const MatrixBlock& block, const float* x, int fields, float* y) {
  return fields == kFieldGroup ? addAllRows<Floats4, 4, 2>(block, x, y)
                               : addAllRows<Floats4, 2, 6>(block, x, y);
}

auto fastestProduct() {
#if defined(__x86_64__)
  if (fastestInstructionSet() != InstructionSet::kBaseline) return addBlockProductAvx2;
#endif
  return addBlockProductBaseline;
}

}  // namespace

void addBlockProduct(const MatrixBlock& block, const float* x, int fields, float* y) {
  static const auto product = fastestProduct();
  product(block, x, fields, y);
}

}  // namespace ambient
