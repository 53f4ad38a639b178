#pragma once

// Saved states of a world and its fluid, as bytes.
#include "bullet_ambient/bullet/state/world_state.h"
