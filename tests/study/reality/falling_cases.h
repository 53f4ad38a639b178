#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "demos/analysis/path_summary.h"

namespace ambient {

/// One body that falls, rises or flies, tilted about y. Its normal or axis is z.
struct FallingCase {
  std::string family;    ///< "disc", "spheroid", "strip", "plate", "card", "coin", "cube", ...
  std::string name;      ///< the body within the family
  double parameter = 0;  ///< I*, Froude number, h/l, mass per area, mass, or size
  double tilt = 0;       ///< [deg]
  std::shared_ptr<const FluidBody> body = nullptr;
  double mass = 0;                    ///< [kg]
  Vector3 inertia = Vector3::Zero();  ///< principal moments [kg m^2]
  Medium medium = {};
  double gravity = 9.81;
  Vector3 velocity = Vector3::Zero();  ///< at the release [m/s]
  Vector3 spin = Vector3::Zero();      ///< at the release [rad/s]
  double roughness = 0;                ///< [m]
  Vector3 end = Vector3::Zero();       ///< measured place at the end, from the release [m]
  double time_step = 0;
  double duration = 0;
  bool keeps_path = false;
  double depth = 0;  ///< at which the horizontal distance from the release is taken [m]; 0: nowhere
};

/// Reads the cases of a group of data/reality/falls.json, such as "cards"; of all without a name.
/// Solves the flow around each body once.
/// @throws std::runtime_error or nlohmann::json::exception if the file is damaged.
std::vector<FallingCase> readFallingCases(const std::filesystem::path& file,
                                          const std::string& group = {});

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
