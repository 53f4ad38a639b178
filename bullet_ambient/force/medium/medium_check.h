#pragma once

#include <optional>

#include "bullet_ambient/force/medium/medium.h"

namespace ambient {

/// A number of a medium that no fluid has.
struct MediumFault {
  const char* quantity;
  const char* unit;
  double value;
  const char* limit;  ///< what it must be
};

/// Finds the first fault of a medium; none: density and viscosity are finite and not negative,
/// velocity and acceleration finite.
std::optional<MediumFault> faultOf(const Medium& medium) noexcept;

}  // namespace ambient
