#pragma once

// makeSolver(): a constraint solver of your choice for the world of a fluid.
#include "bullet_ambient/bullet/solver/fluid_solver.h"
#include "bullet_ambient/fluid.h"
