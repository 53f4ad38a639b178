#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/potential_flow/study/accuracy_case.h"

namespace ambient::study {

/// An added mass, and minimum times of several takes.
struct TimedAddedMass {
  Matrix6 added_mass = Matrix6::Zero();
  double processor_seconds = std::numeric_limits<double>::infinity();  ///< sum of all threads
  double wall_seconds = std::numeric_limits<double>::infinity();
};

/// Times solve(), which returns the added mass.
template <typename Solve>
TimedAddedMass takeTime(int takes, const Solve& solve) {
  TimedAddedMass best;
  for (int take = 0; take < takes; ++take) {
    const double begin = processorSeconds();
    const auto start = std::chrono::steady_clock::now();
    best.added_mass = solve();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    best.processor_seconds = std::min(best.processor_seconds, processorSeconds() - begin);
    best.wall_seconds = std::min(best.wall_seconds, wall.count());
  }
  return best;
}

/// Runs point sources in numpy; returns numbers printed by the script for the mesh.
/// @throws std::runtime_error if the script fails.
TimedAddedMass runPointSources(const std::string& script, bool exact_flux, int takes,
                               const TriangleMesh& mesh);

}  // namespace ambient::study
