#pragma once

#include <pybind11/numpy.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "preprocess/builder/body_maker.h"

namespace ambient {

/// Argument that takes any array. Arrays of float64 in row-major order are not copied, others are.
using InputArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Marks an array as read-only for Python.
inline pybind11::array readOnly(pybind11::array array) {
  pybind11::detail::array_proxy(array.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Copies an Eigen matrix or vector to a read-only array.
template <class Matrix>
pybind11::array arrayOf(const Matrix& matrix) {
  std::vector<pybind11::ssize_t> shape{matrix.rows()};
  if (matrix.cols() > 1) shape.push_back(matrix.cols());
  pybind11::array_t<double> array(shape);
  double* to = array.mutable_data();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) *to++ = matrix(i, j);
  return readOnly(std::move(array));
}

/// Converts an array of three numbers. @throws ValueError that begins with `name`
inline Vector3 vectorFrom(const InputArray& array, const std::string& name) {
  if (array.ndim() != 1 || array.shape(0) != 3)
    throw pybind11::value_error(name + " must be three numbers");
  return {array.data()[0], array.data()[1], array.data()[2]};
}

/// Converts a twist (6,), angular part first. @throws ValueError that begins with "twist"
inline Twist twistFrom(const InputArray& array) {
  if (array.ndim() != 1 || array.shape(0) != 6)
    throw pybind11::value_error("twist must be six numbers");
  const double* x = array.data();
  return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

/// Converts a quaternion (4,) w, x, y, z. @throws ValueError that begins with "orientation"
inline Quaternion quaternionFrom(const InputArray& array) {
  if (array.ndim() != 1 || array.shape(0) != 4)
    throw pybind11::value_error("orientation must be four numbers");
  const double* q = array.data();
  const Quaternion quaternion(q[0], q[1], q[2], q[3]);
  if (!(quaternion.norm() > 0)) throw pybind11::value_error("orientation must have a length > 0");
  return quaternion.normalized();
}

/// Returns the shape of an array as text, such as "(4, 3)".
inline std::string shapeText(const pybind11::array& array) {
  return pybind11::str(array.attr("shape")).cast<std::string>();
}

/// Converts a str or os.PathLike; does not expand "~". @throws TypeError
inline std::filesystem::path pathFrom(const pybind11::object& path) {
  return pybind11::module_::import("os").attr("fspath")(path).cast<std::string>();
}

/// Returns the folder of a cache; None: the user's.
inline BodyFolder folderFrom(const pybind11::object& cache) {
  return cache.is_none() ? userBodyFolder() : BodyFolder(pathFrom(cache));
}

/// Checks that a file can be opened. @throws the matching subclass of OSError if not
inline void requireReadable(const std::filesystem::path& file) {
  pybind11::module_::import("io").attr("open")(file.string(), "rb").attr("close")();
}

/// Calls a function that writes a file. @throws OSError in place of its std::runtime_error
template <class Write>
void writeOrOsError(const Write& write) {
  try {
    write();
  } catch (const std::runtime_error& error) {
    PyErr_SetString(PyExc_OSError, error.what());
    throw pybind11::error_already_set();
  }
}

/// Converts a number, bool or text that a program has given. @throws TypeError that begins with
/// `name`, for values of another type and for whole numbers that are too large
template <class Value>
Value valueFrom(const pybind11::handle& value, const std::string& name) {
  try {
    return value.cast<Value>();
  } catch (const pybind11::cast_error&) {
    std::string wanted = "a text";
    if constexpr (std::is_same_v<Value, bool>)
      wanted = "True or False";
    else if constexpr (std::is_integral_v<Value>)
      wanted = "a whole number of at most " + std::to_string(std::numeric_limits<Value>::max());
    else if constexpr (std::is_floating_point_v<Value>)
      wanted = "a number";
    throw pybind11::type_error(name + " is " + std::string(pybind11::repr(value)) + "; must be " +
                               wanted);
  }
}

/// Names the first number in a Python value that is not finite, such as "bodies[0].mass is nan".
/// @param place of the value; empty or ending in a blank: it is the whole
/// @return empty if there is none
inline std::string notFiniteIn(const pybind11::object& value, const std::string& place) {
  namespace py = pybind11;
  if (py::hasattr(value, "tolist")) return notFiniteIn(value.attr("tolist")(), place);
  if (PyFloat_Check(value.ptr()) && !std::isfinite(PyFloat_AS_DOUBLE(value.ptr())))
    return place + " is " + py::str(value).cast<std::string>();
  const bool is_dict = py::isinstance<py::dict>(value);
  if (!is_dict && !py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value)) return {};
  std::size_t index = 0;
  for (const py::handle entry : value) {
    const std::string key = py::str(entry), dot = place.empty() || place.back() == ' ' ? "" : ".";
    const std::string part = is_dict ? dot + key : "[" + std::to_string(index++) + "]";
    const py::object inner =
        is_dict ? py::object(value[entry]) : py::reinterpret_borrow<py::object>(entry);
    const std::string found = notFiniteIn(inner, place + part);
    if (!found.empty()) return found;
  }
  return {};
}

/// Returns a Python value as JSON text; NumPy values are converted.
/// @param place of the value in messages, as of notFiniteIn()
/// @throws TypeError, ValueError for a number that is not finite
inline std::string jsonFrom(const pybind11::object& value, const std::string& place = {}) {
  namespace py = pybind11;
  const auto plain = py::cpp_function([](const py::object& array) {
    if (!py::hasattr(array, "tolist"))
      throw py::type_error("not a number, text, list or dict: " +
                           py::repr(array).cast<std::string>());
    return array.attr("tolist")();
  });
  try {
    return py::module_::import("json")
        .attr("dumps")(value, py::arg("default") = plain, py::arg("allow_nan") = false)
        .cast<std::string>();
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) || std::strstr(error.what(), "Circular")) throw;
    throw py::value_error(notFiniteIn(value, place) + "; must be finite");
  }
}

}  // namespace ambient
