#pragma once

// Added mass of a mesh by boundary elements.
#include "preprocess/potential_flow/results/potential_flow.h"
