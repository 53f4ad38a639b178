#include <pybind11/pybind11.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "demos/python/bindings.h"
#include "preprocess/builder/fluid_body_builder.h"

namespace {

/// Translates exceptions of the library: unusable files become OSError, other faults of an input
/// ValueError. Messages stay the same.
void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const pybind11::builtin_exception& error) {
    error.set_error();
  } catch (const std::system_error& error) {
    PyErr_SetString(PyExc_OSError, error.what());
  } catch (const std::logic_error& error) {
    // std::logic_error: the world is in use by another thread, or an argument is invalid.
    const bool is_argument = dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
    PyErr_SetString(is_argument ? PyExc_ValueError : PyExc_RuntimeError, error.what());
  } catch (const std::runtime_error& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "What bullet_ambient is made of; import that.";
  pybind11::register_local_exception_translator(&translate);
  module.attr("library_version") = ambient::libraryVersion();
  ambient::bindSettings(module);
  ambient::bindFluidBody(module);
  ambient::bindScene(module);
  ambient::bindMotion(module);
  ambient::bindRobot(module);
  ambient::bindWorld(module);
  ambient::bindSweep(module);
  ambient::bindWorldBatch(module);
}
