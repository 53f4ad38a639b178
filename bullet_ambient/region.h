#pragma once

// Regions of fluid: pools, seas, wind zones, currents, and their surfaces.
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/force/medium/waves.h"
