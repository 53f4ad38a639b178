#pragma once

#include <pybind11/pybind11.h>

namespace ambient {

// Each adds its part of the module; in this order, for signatures name the types before them.

void bindSettings(pybind11::module_& module);
void bindFluidBody(pybind11::module_& module);
void bindScene(pybind11::module_& module);
void bindMotion(pybind11::module_& module);
void bindWorld(pybind11::module_& module);
void bindSweep(pybind11::module_& module);

}  // namespace ambient
