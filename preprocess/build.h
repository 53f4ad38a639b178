#pragma once

// From a mesh or a shape to a fluid body, and to its file.
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/resistance/prepare.h"
