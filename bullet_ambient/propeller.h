#pragma once

// Propeller: thrust, torque and power by a table, the Wageningen B series or as an ideal disc.
#include "bullet_ambient/force/law/propeller.h"
