#pragma once

// Surfaces of water in waves.
#include "bullet_ambient/force/medium/airy_waves.h"
#include "bullet_ambient/force/medium/wave_spectrum.h"
