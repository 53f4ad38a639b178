#pragma once

// Fluid bodies in the words of other programs: SDFormat, MJCF, Fossen's matrices.
#include "preprocess/hand_over/handed_body.h"
