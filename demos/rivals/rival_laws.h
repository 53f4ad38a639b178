#pragma once

#include "bullet_ambient/force/law/flow_settings.h"

namespace ambient {

/// Drag linear in the velocity, as in Weissmann and Pinkall 2012 ("UWRBD" in Padilla et al. 2025,
/// who set that paper's factor lambda between linear and angular inertia to 1). A surface that
/// moves with velocity u = v + w x z has the traction -rho c u [Pa]. The speed c [m/s] is the
/// method's free parameter. On a sphere: force -rho c A v and torque -2/3 rho c A R^2 w, without
/// coupling, hence no lift.
/// @throws std::invalid_argument if `drag_speed` [m/s] is not positive and finite.
LoadLaw linearDrag(double drag_speed);

/// Momentum flux on windward faces: f_i = -1/2 rho A_i max(n_i . u_i, 0) u_i, with the velocity
/// u_i = v + w x c_i of the face. Replaces the lift and drag per face of Soliman et al. 2024
/// ("GwtF"), which is unpublished; behaves as Padilla et al. 2025 report of that method. On a
/// sphere: C_D = 1, side force pi/3 rho R^3 v x w, opposite to the Magnus force.
LoadLaw windwardFlux();

}  // namespace ambient
