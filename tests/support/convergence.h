#pragma once

#include <cmath>
#include <vector>

namespace ambient::test {

/// Root mean square of error(i), i = 0 ... count - 1.
template <class Error>
double rootMeanSquare(int count, const Error& error) {
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double e = error(i);
    sum += e * e;
  }
  return std::sqrt(sum / count);
}

/// Errors on a sequence of meshes, each with edges half as long as those before.
struct Convergence {
  std::vector<double> errors;

  double finest() const { return errors.back(); }
  /// Mean order between the coarsest and the finest mesh.
  double order() const {
    return std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
  }
};

/// Returns error(level) for each level of refinement.
template <class Error>
Convergence measureConvergence(int first_level, int last_level, const Error& error) {
  Convergence convergence;
  for (int level = first_level; level <= last_level; ++level)
    convergence.errors.push_back(error(level));
  return convergence;
}

}  // namespace ambient::test
