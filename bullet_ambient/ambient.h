#pragma once

// Bodies in air and water for a Bullet program:
//
//   ambient::Fluid<> fluid;
//   btDiscreteDynamicsWorld world(dispatcher, broadphase, &fluid.solver(), configuration);
//   fluid.attachTo(world);
//   fluid.add(body, {ambient::loadFluidBody("plate.ambient"), ambient::water()});
//
// Apart from it: bullet/world_state.h and bullet/ambient_serializer.h (saved states),
// bullet/ambient_impulse.h (impulses that feel the fluid), tasks/thread_pool.h and
// bullet/bullet_task_runner.h (threads), force/surface_loads.h (loads by a law of your own).
#include "bullet_ambient/bullet/fluid.h"
#include "bullet_ambient/bullet/multibody_dynamics.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/load_fluid_body.h"
