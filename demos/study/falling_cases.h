#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/medium.h"
#include "demos/analysis/falling_mode.h"

namespace ambient {

/// One body that falls or rises from rest, tilted about y. Its normal or axis is z.
struct FallingCase {
  std::string family;    ///< "disc", "strip", "plate", "card", "coin", "cube", "sphere"
  std::string name;      ///< of the body within the family
  double parameter = 0;  ///< I*, Froude number, h/l, mass per area, mass, or size
  double tilt = 0;       ///< [deg]
  std::shared_ptr<const FluidBody> body = nullptr;
  double mass = 0;                    ///< [kg]
  Vector3 inertia = Vector3::Zero();  ///< principal moments [kg m^2]
  Medium medium = {};
  double gravity = 9.81;
  double time_step = 0;
  double duration = 0;
  bool keeps_path = false;
};

/// Bodies whose fall was measured.
std::vector<FallingCase> makeFallingCases();

/// What came of one.
struct FallingRun {
  std::vector<MotionSample> motion;  ///< after each step
  Fall fall;                         ///< of the second half
  double substeps = 0;               ///< per step
  double coarse = 0;                 ///< share of steps above the tolerance
};

FallingRun runFall(const FallingCase& falling_case, PressureLaw law);

// Lines of CSV. Speeds are means over the last quarter of the fall, the spin that of overturning
// over the second half.
std::string fallHeader();
std::string fallLine(const FallingCase& falling_case, PressureLaw law, const FallingRun& run);
std::string pathHeader();
std::string pathLines(const FallingCase& falling_case, PressureLaw law, const FallingRun& run);

}  // namespace ambient
