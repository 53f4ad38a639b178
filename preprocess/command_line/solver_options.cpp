#include "preprocess/command_line/solver_options.h"

#include <cmath>
#include <cstdlib>

#include "preprocess/mesh/input_error.h"

namespace ambient {

void requireThreads(int threads) {
  constexpr int kMostThreads = 256;
  if (threads < 0) raiseInputError("--threads", threads, " is below 0 (0: all cores)");
  if (threads > kMostThreads) raiseInputError("--threads", threads, " is above ", kMostThreads);
}

FlowSolverKind parseSolver(const std::string& name) {
  if (name.empty()) return FlowSolverKind::Automatic;
  if (name == "dense") return FlowSolverKind::Dense;
  if (name == "hierarchical") return FlowSolverKind::Hierarchical;
  raiseInputError("--solver", "\"", name, "\" is neither dense nor hierarchical");
}

double parseMemory(const std::string& gigabytes) {
  if (gigabytes.empty()) return 0;
  char* end = nullptr;
  const double value = std::strtod(gigabytes.c_str(), &end);
  if (*end != '\0' || !std::isfinite(value) || value <= 0) {
    raiseInputError("--memory", "\"", gigabytes, "\" is not a number of gigabytes above 0");
  }
  return 1e9 * value;
}

}  // namespace ambient
