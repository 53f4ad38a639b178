#pragma once

// Shapes as data.
#include "preprocess/shape/shapes.h"
