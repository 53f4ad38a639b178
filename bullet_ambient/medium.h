#pragma once

// Medium, air() and water().
#include "bullet_ambient/force/medium/medium.h"
