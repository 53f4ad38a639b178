#pragma once

#include <string>
#include <vector>

#include "demos/analysis/falling_mode.h"
#include "demos/study/falling_cases.h"

namespace ambient {

/// What came of one.
struct FallingRun {
  std::vector<MotionSample> motion;  ///< after each step
  Fall fall;                         ///< of the second half
  double substeps = 0;               ///< per step
  double coarse = 0;                 ///< share of steps above the tolerance
};

FallingRun runFall(const FallingCase& falling_case, PressureLaw law);

// Lines of CSV. Speeds, and the spin about y, are means over the second half.
std::string fallHeader();
std::string fallLine(const FallingCase& falling_case, PressureLaw law, const FallingRun& run);
std::string pathHeader();
std::string pathLines(const FallingCase& falling_case, PressureLaw law, const FallingRun& run);

}  // namespace ambient
