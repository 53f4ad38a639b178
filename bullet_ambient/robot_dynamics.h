#pragma once

// Mass matrix and inverse dynamics of a btMultiBody in a fluid.
#include "bullet_ambient/bullet/world/multibody_dynamics.h"
