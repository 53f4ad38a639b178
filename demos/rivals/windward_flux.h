#pragma once

#include "bullet_ambient/force/flow_settings.h"

namespace ambient {

/// Momentum flux on windward faces: f_i = -1/2 rho A_i max(n_i . u_i, 0) u_i with the velocity u_i
/// = v + w x c_i of the face. A stand-in for the lift and drag per face of Soliman et al. 2024
/// ("GwtF"), whose own rule no public source gives; it behaves as Padilla et al. 2025 report of it.
/// On a sphere: C_D = 1, side force pi/3 rho R^3 v x w, against Magnus'.
LoadLaw windwardFlux();

}  // namespace ambient
