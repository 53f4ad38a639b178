#pragma once

#include "bullet_ambient/force/flow_settings.h"

namespace ambient {

/// Drag that is linear in the velocity, as in Weissmann and Pinkall 2012 ("UWRBD" in Padilla et
/// al. 2025, who set that paper's factor lambda between linear and angular inertia to 1): the
/// traction -rho c u [Pa] wherever the surface moves with velocity u = v + w x z. The speed c [m/s]
/// is the method's free parameter. On a sphere: force -rho c A v, torque -2/3 rho c A R^2 w,
/// whatever the other of the two is; hence no lift.
/// @throws std::invalid_argument if `drag_speed` [m/s] is not positive and finite.
LoadLaw linearDrag(double drag_speed);

}  // namespace ambient
