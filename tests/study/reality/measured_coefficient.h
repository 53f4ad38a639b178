#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/flow_settings.h"

namespace ambient {

/// Motion of a measured body, and measured quantity: "flow" in data/reality/measurements.json.
struct MeasuredFlow {
  /// Measured quantity: "drag", "lift" of a ball on the frontal area; "normal" to a plate or wing,
  /// its "lift", on the plan area; "spin torque" over rho pi R^3 v^2 S; "stall angle" of largest
  /// lift [deg].
  std::string of;
  Vector3 velocity{1, 0, 0};  ///< velocity of the body
  bool is_mean = false;       ///< mean over directions, area of the sphere of equal volume
  double spin = 0;            ///< R w / V of a ball, w across the flow
};

/// @throws std::invalid_argument that names the unknown quantity.
MeasuredFlow readMeasuredFlow(const nlohmann::json& flow);

/// Computes this quantity by the library at a Reynolds number of 1e5 per unit of length. Settings
/// other than the law have their default.
double computeCoefficient(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law);

}  // namespace ambient
