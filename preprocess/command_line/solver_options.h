#pragma once

#include <string>

#include "preprocess/potential_flow/potential_flow.h"

namespace ambient {

/// @throws std::runtime_error unless it is 0 (all cores) to 256.
void requireThreads(int threads);

/// The solver named by --solver: dense, hierarchical, or none.
/// @throws std::runtime_error that lists them.
FlowSolverKind parseSolver(const std::string& name);

/// The limit that --memory sets [bytes]; 0: none was set.
/// @throws std::runtime_error unless it is positive and finite.
double parseMemory(const std::string& gigabytes);

}  // namespace ambient
