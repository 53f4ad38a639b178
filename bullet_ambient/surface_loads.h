#pragma once

// SurfaceLoads: derive from it for loads by a law of your own.
#include "bullet_ambient/force/loads/surface_loads.h"
