#pragma once

// Surfaces of water in waves.
#include "bullet_ambient/force/medium/waves.h"
