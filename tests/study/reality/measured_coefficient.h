#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/flow_settings.h"

namespace ambient {

/// Motion of a measured body, and measured quantity: "flow" in data/reality/measurements.json.
struct MeasuredFlow {
  /// Measured quantity: "drag", "lift" of a ball on the frontal area; "normal" to a plate or wing,
  /// its "lift", on the plan area; "side": force across the axis of a hull, on the area ahead, per
  /// radian; "spin torque" over rho pi R^3 v^2 S; "stall angle" of largest lift [deg].
  std::string of;
  Vector3 velocity{1, 0, 0};  ///< velocity of the body
  bool is_mean = false;       ///< mean over directions, area of the sphere of equal volume
  double spin = 0;            ///< R w / V of a ball, w across the flow
  double reynolds = 1e5;      ///< on `length`
  double length = 1;          ///< over the unit of the shape
  double roughness = 0;       ///< height over the unit of the shape
  double area = 0;            ///< of the coefficient in units of the shape; 0: as `of` says
};

/// @throws std::invalid_argument that names the unknown quantity.
MeasuredFlow readMeasuredFlow(const nlohmann::json& flow);

/// Computes this quantity by the library. Settings other than law and roughness have their default.
double computeCoefficient(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law);

/// Computes the terminal speed of a body with this weight, over the one that was measured.
/// drag: measured coefficient.
double computeSettling(const FluidBody& body, const MeasuredFlow& flow, double drag,
                       PressureLaw law);

}  // namespace ambient
