#pragma once

// Air and water for the bodies of a Bullet program:
//
//   ambient::Fluid fluid(world);
//   fluid.add(body, {ambient::loadFluidBody("plate.ambient"), ambient::water()});
//
// Includes what a usual program needs. Besides: solver.h, surface_loads.h, impulse.h, reading.h,
// robot_dynamics.h, threads.h.
#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/drawing.h"
#include "bullet_ambient/flight.h"
#include "bullet_ambient/flow.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/fluid_body.h"
#include "bullet_ambient/medium.h"
#include "bullet_ambient/region.h"
#include "bullet_ambient/saved_state.h"
#include "bullet_ambient/waves.h"
