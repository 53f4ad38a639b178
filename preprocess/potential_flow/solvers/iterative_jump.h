#pragma once

#include "preprocess/potential_flow/operators/hypersingular.h"
#include "preprocess/potential_flow/solvers/pair_integrals.h"

namespace ambient {

/// Solution of W mu = -B without the matrix W.
struct IterativeJump {
  Eigen::Matrix<double, Eigen::Dynamic, 6> values;  ///< U x 6, of mean 0 on closed components
  int iterations = 0;
};

/// Solves by conjugate gradients, all six motions side by side. Preconditioner: the single layer,
/// whose product with W is about a fourth of unity; docs/theory.md eq. (34). The same bits for
/// every number of threads.
/// @throws std::runtime_error if they do not converge.
IterativeJump solveIteratively(const PanelSurface& surface, const Unknowns& unknowns,
                               const PairIntegrals& integrals, int threads);

}  // namespace ambient
