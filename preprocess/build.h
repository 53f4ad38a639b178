#pragma once

// From a mesh or a shape to a fluid body.
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
