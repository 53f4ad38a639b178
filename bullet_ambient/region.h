#pragma once

// Regions of fluid: pools, seas, wind zones, currents, and their surfaces.
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/force/medium/water_surface.h"
#include "bullet_ambient/immersed/region_id.h"
