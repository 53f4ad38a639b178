#pragma once

// From a btCollisionShape to a fluid body; the cache that Fluid::addAll() asks.
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
