#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

// Bind parts of the Python class FluidBody, one source each.

/// Binds from_mesh(), from_shape(), read(), write() and scaled().
void bindMakers(pybind11::class_<FluidBody, std::shared_ptr<FluidBody>>& type);

/// Binds export().
void bindExport(pybind11::class_<FluidBody, std::shared_ptr<FluidBody>>& type);

}  // namespace ambient
