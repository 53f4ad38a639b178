#include "tests/preprocess/table_generator/box_flow.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/potential_flow.h"

namespace ambient {
namespace {

constexpr int kCoarse = 3, kFine = 5;  // multiples of the least divisions
constexpr double kMostTriangles = 11000;
// Twice the order of square-root grading times the exponent 2/3 of an edge's potential.
constexpr double kOrder = 8.0 / 3;

using Divisions = std::array<int, 3>;

Divisions times(int factor, const Divisions& divisions) {
  return {factor * divisions[0], factor * divisions[1], factor * divisions[2]};
}

double trianglesOf(const Divisions& n) { return 4.0 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]); }

/// Even numbers, proportional to the square root of the length.
Divisions leastDivisions(const Vector3& half_sizes) {
  Divisions least = {2, 2, 2};
  for (int longest = 2;; longest += 2) {
    Divisions n{};
    for (int k = 0; k < 3; ++k) {
      const double wanted = longest * std::sqrt(half_sizes[k] / half_sizes.maxCoeff());
      n[k] = std::max(2, 2 * static_cast<int>(std::lround(wanted / 2)));
    }
    if (trianglesOf(times(kFine, n)) > kMostTriangles) return least;
    least = n;
  }
}

Vector6 solveOn(const Vector3& half_sizes, const Divisions& divisions) {
  return solvePotentialFlow(makeBoxMesh(half_sizes, divisions)).added_mass.diagonal();
}

}  // namespace

Vector6 solveBoxFlow(const Vector3& half_sizes) {
  const Divisions least = leastDivisions(half_sizes);
  const Vector6 coarse = solveOn(half_sizes, times(kCoarse, least));
  const Vector6 fine = solveOn(half_sizes, times(kFine, least));
  const double ratio = portable::pow(static_cast<double>(kFine) / kCoarse, kOrder);
  return fine + (fine - coarse) / (ratio - 1);
}

}  // namespace ambient
