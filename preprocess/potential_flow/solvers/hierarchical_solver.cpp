#include "preprocess/potential_flow/solvers/hierarchical_solver.h"

#include "preprocess/base/large_products.h"
#include "preprocess/potential_flow/operators/tree_double_layer.h"
#include "preprocess/potential_flow/solvers/iterative_jump.h"
#include "preprocess/potential_flow/solvers/memory_limit.h"

namespace ambient {
namespace {

// The energy, quadratic in the jump, comes out within 1e-5. The rotation block is linear in the
// double layer, of whose two sides a thin body leaves little: a degree of 5 would leave 1e-4 of it.
constexpr int kLeafSize = 64;
constexpr int kDegree = 5;
constexpr int kDoubleLayerDegree = 8;
constexpr double kOpening = 0.7;
constexpr double kBytesPerPanel = 2000;  // of geometry, tree, fields and moments; measured

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
  const IterativeJump solved = solveIteratively(tree_.surface, unknowns, integrals, threads_);
  return {atVertices(unknowns, solved.values), solved.iterations};
}

PanelMoments HierarchicalSolver::computeMoments(const Jump& jump) {
  return computeExteriorMoments(tree_, pairs_, kDoubleLayerDegree, jump.values, threads_);
}

}  // namespace ambient
