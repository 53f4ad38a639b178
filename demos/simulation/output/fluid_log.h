#pragma once

#include <string>

#include "demos/simulation/simulation.h"

namespace ambient {

/// Further columns of trajectory.csv: what the fluid does to a body.
struct FluidLog {
  bool wrench = false;  ///< wrenches by part in the step that ends at the row's time, or after it
  bool wet = false;     ///< what is wet of the body after that step

  bool isEmpty() const { return !wrench && !wet; }
};

/// Reads "wrench", "wet" or "wrench,wet".
/// @throws std::invalid_argument naming a word that is none of these.
FluidLog parseFluidLog(const std::string& words);

/// Names of the columns, each after a comma.
std::string fluidLogHeader(const FluidLog& log);

/// Values of one body now, each after a comma; 17 significant digits.
std::string fluidLogRow(const FluidLog& log, const Simulation& simulation, std::size_t body);

}  // namespace ambient
