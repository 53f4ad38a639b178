#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/flow_settings.h"

namespace ambient {

/// How a measured body moves, and what was measured: "flow" in data/reality/measurements.json.
struct MeasuredFlow {
  /// "drag" and "lift" on the frontal area; "normal" to a plate on its own; "spin torque" over rho
  /// pi R^3 v^2 S; "stall angle" of largest lift [deg].
  std::string of;
  Vector3 velocity{1, 0, 0};  ///< of the body
  bool is_mean = false;       ///< over all directions, on the area of the sphere of equal volume
  double spin = 0;            ///< R w / V of a ball, across the flow
};

/// @throws std::invalid_argument, naming what is not known.
MeasuredFlow readMeasuredFlow(const nlohmann::json& flow);

/// The same number by this library at a Reynolds number of 1e5 over the unit of length, with its
/// default settings but for the law.
double computeCoefficient(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law);

}  // namespace ambient
