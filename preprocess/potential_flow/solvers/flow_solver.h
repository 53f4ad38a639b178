#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/operators/panel_tree.h"
#include "preprocess/potential_flow/operators/solid_harmonics.h"

namespace ambient {

/// The symmetric matrix of all pair integrals I(t, s) (docs/theory.md eq. (9)) of a tree's panels:
/// near leaves entry by entry in single precision, far clusters as expansions.
class PairIntegrals {
 public:
  PairIntegrals(const PanelTree& tree, const ClusterPairs& pairs, int degree, int threads);

  /// Computes I x for several columns at once, at most 24; the same bits for every number of
  /// threads.
  Eigen::MatrixXf apply(const Eigen::MatrixXf& x) const;

  /// Returns I(t, s). @pre the leaves of both panels are near, as for panels that touch
  double entry(Eigen::Index t, Eigen::Index s) const;

  /// Memory of the entries between near leaves [bytes].
  static double nearBytes(const PanelTree& tree, const ClusterPairs& pairs);

 private:
  using Block = Eigen::Map<const Eigen::MatrixXf>;
  using FieldRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void fillNear(int t, int s);
  void fillLeafHarmonics(int leaf);
  /// Entries between leaves t <= s.
  std::size_t nearOffset(int t, int s) const;
  Block nearBlock(int t, int s) const;
  /// y += I x for the rows of leaf t and the columns of leaf s.
  void addNear(int t, int s, const FieldRows& x, FieldRows& y) const;
  const PanelCluster& leaf(int k) const { return tree_.clusters[tree_.leaves[k]]; }

  const PanelTree& tree_;
  const ClusterPairs& pairs_;
  ClusterExpansions expansions_;
  int threads_;
  Eigen::MatrixXf panel_harmonics_;  ///< a column per panel: integrals of the regular harmonics
  std::vector<std::vector<std::size_t>> offset_;  ///< beside ClusterPairs::near, for t <= s
  std::vector<float> near_;
};

/// Returns the memory limit [bytes]: the setting, or the available memory if the setting is 0.
double memoryLimit(double setting);

/// @throws std::runtime_error in one line with both numbers if `bytes` is above `limit`.
void requireMemory(Eigen::Index panels, double bytes, double limit);

/// Reports that memory was not available. @throws std::runtime_error in one line, with the needed
/// `bytes` if above 0.
[[noreturn]] void raiseOutOfMemory(Eigen::Index panels, double bytes);

/// Jump of the potential across the surface, and data on its solution.
struct Jump {
  Eigen::Matrix<double, Eigen::Dynamic, 6> values;  ///< V x 6, 0 where there is no unknown
  int iterations = 0;                               ///< iterations; 0: the matrix was factorised
};

/// Values at all vertices from those of the unknowns, U x 6; 0 where there is no unknown.
inline Eigen::Matrix<double, Eigen::Dynamic, 6> atVertices(
    const Unknowns& unknowns, const Eigen::Matrix<double, Eigen::Dynamic, 6>& of_unknowns) {
  const auto vertices = static_cast<Eigen::Index>(unknowns.of_vertex.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> values;
  values.setZero(vertices, 6);
  for (Eigen::Index v = 0; v < vertices; ++v)
    if (const int i = unknowns.of_vertex[v]; i >= 0) values.row(v) = of_unknowns.row(i);
  return values;
}

/// Interface of the solvers: the integral operators of a surface that the flow needs.
class FlowSolver {
 public:
  virtual ~FlowSolver() = default;

  /// The surface, perhaps with its panels in another order; vertices keep their numbers.
  virtual const PanelSurface& surface() const = 0;

  /// Estimate of the memory that the solver needs [bytes].
  virtual double bytesNeeded() const = 0;

  /// Solves W mu = -B; docs/theory.md eq. (8).
  /// @throws std::runtime_error if it has no solution.
  virtual Jump solveJump(const Unknowns& unknowns) = 0;

  /// Moments of the exterior potentials on the panels of surface(); docs/theory.md eq. (11).
  virtual PanelMoments computeMoments(const Jump& jump) = 0;

 protected:
  FlowSolver() = default;
  FlowSolver(const FlowSolver&) = default;
  FlowSolver& operator=(const FlowSolver&) = default;
};

/// Solves iteratively, with far clusters of panels as expansions.
class HierarchicalSolver final : public FlowSolver {
 public:
  /// @throws std::runtime_error if it would need more than `memory_limit` bytes.
  HierarchicalSolver(const PanelSurface& surface, int threads, double memory_limit);

  const PanelSurface& surface() const override { return tree_.surface; }
  double bytesNeeded() const override;
  Jump solveJump(const Unknowns& unknowns) override;
  PanelMoments computeMoments(const Jump& jump) override;

 private:
  int threads_;
  PanelTree tree_;
  ClusterPairs pairs_;
};

}  // namespace ambient
