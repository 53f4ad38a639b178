#pragma once

#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

AMBIENT_BEGIN

/// Returns the first fault of a saved state that no world can have had, as words that follow "the
/// saved state", with body or contact and value; empty if there is none. Of the fluid it checks
/// only the flight's memory: makeBodyModel() checks the rest.
std::string findFault(const WorldState& state);

AMBIENT_END
