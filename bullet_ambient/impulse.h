#pragma once

// Impulses that feel the inertia of the fluid, for vehicles and characters.
#include "bullet_ambient/bullet/world/ambient_impulse.h"
