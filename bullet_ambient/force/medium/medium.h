#pragma once

#include <optional>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Fluid around one body. All vectors in the world frame W.
struct Medium {
  double density = 0;             ///< [kg/m^3], >= 0
  double viscosity = 0;           ///< dynamic [Pa s], 0 to 1e24; 0 switches skin friction off
  Vector3 velocity{0, 0, 0};      ///< ambient velocity at the body, without its disturbance [m/s]
  Vector3 acceleration{0, 0, 0};  ///< rate of change of velocity, for unsteady currents [m/s^2]
};

/// Air at 20 C and sea level.
inline Medium air() { return {1.204, 1.82e-5, {0, 0, 0}, {0, 0, 0}}; }
/// Fresh water at 20 C.
inline Medium water() { return {998.0, 1.002e-3, {0, 0, 0}, {0, 0, 0}}; }

/// A number of a medium or of flow settings that is beyond its limits.
struct NumberFault {
  const char* quantity;
  const char* unit;
  double value;
  const char* limit;  ///< what it must be
};

/// Finds the first fault of a medium; none: density and viscosity are finite and not negative,
/// nothing is stiffer than the Earth's mantle, velocity and acceleration are finite.
std::optional<NumberFault> faultOf(const Medium& medium) noexcept;

}  // namespace ambient
