#include "preprocess/potential_flow/solvers/dense_solver.h"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

#include "preprocess/base/large_products.h"
#include "preprocess/potential_flow/solvers/memory_limit.h"

namespace ambient {
namespace {

using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr double kDenseBytesPerPanel =
    15000;  // of near pairs and what is held between passes; measured

}  // namespace

DenseSolver::DenseSolver(const PanelSurface& surface, int threads, double memory_limit)
    : surface_(surface), threads_(threads) {
  requireMemory(surface.panelCount(), bytesNeeded(), memory_limit);
  fixBlocksOfLargeProducts();
  near_ = findNearPanels(surface, threads);
}

double DenseSolver::bytesNeeded() const {
  const auto panels = static_cast<double>(surface_.panelCount());
  const auto vertices = static_cast<double>(surface_.vertexCount());
  return sizeof(double) * vertices * vertices + kDenseBytesPerPanel * panels;
}

Jump DenseSolver::solveJump(const Unknowns& unknowns) {
  Eigen::MatrixXd W = assembleHypersingular(surface_, unknowns, near_, threads_);
  fillKernel(surface_, unknowns, W);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(W);
  if (factors.info() != Eigen::Success)
    throw std::runtime_error("potential flow: the linear system of " +
                             std::to_string(unknowns.count) +
                             " vertices is not positive definite; two sides of the surface are too "
                             "close for the size of "
                             "its triangles: use more triangles, a sheet, or build --wrap");
  const MatrixX6 solution = factors.solve(-assembleNormalVelocity(surface_, unknowns));
  return {atVertices(unknowns, solution), 0};
}

PanelMoments DenseSolver::computeMoments(const Jump& jump) {
  return computeExteriorMoments(surface_, near_, jump.values, threads_);
}

}  // namespace ambient
