#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/surface/surface_model.h"

namespace ambient::study {

/// A free body that enters still water upright in a Bullet world. Weight and buoyancy are
/// negligible against forces of entry.
struct FallDef {
  std::shared_ptr<const FluidBody> shape;  ///< uniform
  double speed = 1;                        ///< at first contact [m/s]
  double time_step = 1.0 / 240;            ///< [s]
  bool has_loads = false;                  ///< true: with pressure and friction on faces
  double specific_gravity = 1000;          ///< default: heavy enough for constant speed
};

/// Mean force of a step, and the draught after it.
struct FallStep {
  double draught_after;  ///< [m]
  RigidState after;      ///< the water's surface is z = 0
  double force;          ///< upwards, over rho V^2 at mid-step [m^2]
};

/// Downward momentum of body and water per density; `model` is the body's [m^4/s].
double momentumOf(const SurfaceModel& model, const RigidState& state);

/// Until it is covered. @throws std::invalid_argument as Fluid::add()
std::vector<FallStep> fallIntoWater(const FallDef& def);

/// Mean force of the step in which the lowest point reached this draught.
double forceAt(const std::vector<FallStep>& fall, double draught);

}  // namespace ambient::study
