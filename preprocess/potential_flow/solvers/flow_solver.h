#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"

namespace ambient {

/// Returns the memory limit [bytes]: the setting, or the available memory if the setting is 0.
double memoryLimit(double setting);

/// @throws std::runtime_error in one line with both numbers if `bytes` is above `limit`.
void requireMemory(Eigen::Index panels, double bytes, double limit);

/// Reports that memory was not available. @throws std::runtime_error in one line, with the needed
/// `bytes` if above 0.
[[noreturn]] void raiseOutOfMemory(Eigen::Index panels, double bytes);

/// A dense block of a matrix in memory.
struct MatrixBlock {
  const float* first;
  std::ptrdiff_t rows, columns;
  std::ptrdiff_t row_stride,
      column_stride;  ///< distance in memory from one row, or column, to the next
};

/// Number of fields in a group; fields are stored side by side in whole groups.
constexpr int kFieldGroup = 8;

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

}  // namespace ambient
