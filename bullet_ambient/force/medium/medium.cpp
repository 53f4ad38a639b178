#include "bullet_ambient/force/medium/medium.h"

#include <cmath>

namespace ambient {

std::optional<NumberFault> faultOf(const Medium& medium) noexcept {
  constexpr const char* kNotNegative = "zero or positive and finite";
  const auto is_wrong = [](double value) { return !(value >= 0) || !std::isfinite(value); };
  if (is_wrong(medium.density))
    return NumberFault{"density", "kg/m^3", medium.density, kNotNegative};
  constexpr double kStiffest = 1e24;  // the mantle has some 1e21
  if (!(medium.viscosity >= 0) || !(medium.viscosity <= kStiffest))
    return NumberFault{"viscosity", "Pa s", medium.viscosity, "from 0 to 1e24"};
  if (!medium.velocity.allFinite())
    return NumberFault{"speed", "m/s", medium.velocity.norm(), "finite"};
  if (!medium.acceleration.allFinite())
    return NumberFault{"acceleration", "m/s^2", medium.acceleration.norm(), "finite"};
  return {};
}

}  // namespace ambient
