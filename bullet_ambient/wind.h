#pragma once

// Wind, currents, gusts, turbulence and densities that regions of fluid take.
#include "bullet_ambient/force/medium/profiles.h"
#include "bullet_ambient/force/medium/turbulence.h"
