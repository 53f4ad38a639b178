#pragma once

// Saved states of a world and its fluid, as bytes and in .bullet files.
#include "bullet_ambient/bullet/state/world_state.h"
#include "bullet_ambient/bullet/world/ambient_serializer.h"
