#pragma once

#include "preprocess/potential_flow/solvers/flow_solver.h"

namespace ambient {

/// Assembles the matrix and factorises it.
class DenseSolver final : public FlowSolver {
 public:
  /// The surface must outlive the solver.
  /// @throws std::runtime_error if it would need more than `memory_limit` bytes.
  DenseSolver(const PanelSurface& surface, int threads, double memory_limit);

  const PanelSurface& surface() const override { return surface_; }
  double bytesNeeded() const override;
  Jump solveJump(const Unknowns& unknowns) override;
  PanelMoments computeMoments(const Jump& jump) override;

 private:
  const PanelSurface& surface_;
  int threads_;
  NearPanels near_;
};

}  // namespace ambient
