#pragma once

// Foil: rudders, fins, hydrofoils by their numbers, for FlowSettings::foils.
#include "bullet_ambient/force/loads/foils.h"
