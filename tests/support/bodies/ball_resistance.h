#pragma once

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient::test {

/// Gives a body the resistance of the ball with its area, about the centre of volume: for tests of
/// what a resistance does, not of what it is.
inline void giveResistance(FluidBody& body) {
  const double pi = portable::acos(-1.0), radius = std::sqrt(body.area / pi) / 2;
  ViscousForm& viscous = body.viscous;
  viscous.resistance.setZero();
  viscous.resistance.diagonal() << Vector3::Constant(8 * pi * radius * radius * radius),
      Vector3::Constant(6 * pi * radius);
  viscous.resistance = shiftOrigin(viscous.resistance, -body.centre_of_volume);
  viscous.centre_of_reaction = body.centre_of_volume;
  viscous.surface = {2 * radius, Vector3::Constant(pi * radius * radius),
                     Vector3::Constant(radius * radius / 3),
                     2.0 / 3 * radius * radius * Matrix3::Identity()};
  viscous.sharp_share = 0.5;
}

}  // namespace ambient::test
