#pragma once

// FluidBody, the data of a shape, its file, and mass properties from its volume.
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
