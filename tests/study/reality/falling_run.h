#pragma once

#include <string>
#include <vector>

#include "demos/analysis/path_summary.h"
#include "tests/study/reality/falling_cases.h"

namespace ambient {

/// Motion and cost of one falling case.
struct FallingRun {
  std::vector<MotionSample> motion;  ///< after each step
  Fall fall;                         ///< over the second half
  double substeps = 0;               ///< per step
  double coarse = 0;                 ///< part of steps with an error above the tolerance
};

FallingRun runFall(const FallingCase& falling_case, PressureLaw law);

// Header and line of a CSV table. Speeds, and the spin about y, are means over the second half.
std::string fallHeader();
std::string fallLine(const FallingCase& falling_case, PressureLaw law, const FallingRun& run);
std::string pathHeader();
std::string pathLines(const FallingCase& falling_case, PressureLaw law, const FallingRun& run);

}  // namespace ambient
