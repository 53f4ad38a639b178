#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Binds FluidBody.export().
void bindExport(pybind11::class_<FluidBody, std::shared_ptr<FluidBody>>& type);

}  // namespace ambient
