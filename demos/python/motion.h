#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Motion of bodies as arrays of shape (..., components).
struct Motion {
  using Shape = std::vector<pybind11::ssize_t>;

  /// All NaN; `shape` without the components.
  explicit Motion(const Shape& shape);

  /// Writes the sample at a place that counts all of `shape`. Needs no lock of the interpreter:
  /// different places may be written by different threads.
  void set(std::size_t place, const MotionSample& sample) noexcept;

  pybind11::array_t<double> times;  ///< (T,) [s]; set by who knows them
  pybind11::array_t<double> position, orientation, twist;

 private:
  double* positions_;
  double* orientations_;
  double* twists_;
};

/// (T, B) of the samples of each body.
Motion motionOf(const std::vector<std::vector<MotionSample>>& samples);

/// array[..., begin:end]
pybind11::object componentsOf(const pybind11::array& array, int begin, int end);

/// x, y, z, w of w, x, y, z.
pybind11::object scalarLast(const pybind11::array& quaternions);

}  // namespace ambient
