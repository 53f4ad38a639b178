#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/motion/rigid_state.h"
#include "bullet_ambient/motion/surface_model.h"

namespace ambient::study {

/// A free body that enters still water upright in a Bullet world; its weight and buoyancy are next
/// to nothing against the forces of the entry.
struct FallDef {
  std::shared_ptr<const FluidBody> shape;  ///< uniform
  double speed = 1;                        ///< at the touch [m/s]
  double time_step = 1.0 / 240;            ///< [s]
  bool has_loads = false;                  ///< pressure and friction on its faces, too
  double specific_gravity = 1000;          ///< by default so heavy that it keeps its speed
};

/// A step: its mean force, and where the lowest point has come to.
struct FallStep {
  double draught_after;  ///< [m]
  RigidState after;      ///< the water's surface is z = 0
  double force;          ///< upwards, over rho V^2, V in the middle [m^2]
};

/// Down, of body and water, per density; the model is that of the body [m^4/s].
double momentumOf(const SurfaceModel& model, const RigidState& state);

/// Until it is covered. @throws std::invalid_argument as AmbientRegistry::attach()
std::vector<FallStep> fallIntoWater(const FallDef& def);

/// The mean force in the step in which the lowest point came to this draught.
double forceAt(const std::vector<FallStep>& fall, double draught);

}  // namespace ambient::study
