#pragma once

// Fluid bodies in the words of other programs: SDFormat, MJCF, Fossen's matrices.
#include "preprocess/hand_over/export_fluid_body.h"
