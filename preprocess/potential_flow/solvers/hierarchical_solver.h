#pragma once

#include "preprocess/potential_flow/operators/panel_tree.h"
#include "preprocess/potential_flow/solvers/flow_solver.h"

namespace ambient {

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
