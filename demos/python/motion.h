#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "demos/analysis/motion_sample.h"

namespace ambient {

/// Motion of bodies as arrays of shape (..., components): position 3, orientation 4, twist 6.
struct Motion {
  using Shape = std::vector<pybind11::ssize_t>;

  /// Arrays filled with NaN; `shape` excludes the dimension of components.
  explicit Motion(const Shape& shape);

  /// Writes a sample; `place`: flat index into `shape`. Does not need the interpreter's lock.
  /// Several threads may write to different places.
  void set(std::size_t place, const MotionSample& sample) noexcept;

  pybind11::array_t<double> times;  ///< (T,) [s]; filled by the caller
  pybind11::array_t<double> position, orientation, twist;

 private:
  double* positions_;
  double* orientations_;
  double* twists_;
};

/// Makes a Motion of shape (T, B) from the samples of each body.
Motion motionOf(const std::vector<std::vector<MotionSample>>& samples);

/// Returns the view array[..., begin:end].
pybind11::object componentsOf(const pybind11::array& array, int begin, int end);

/// Reorders quaternions w, x, y, z to x, y, z, w.
pybind11::object scalarLast(const pybind11::array& quaternions);

}  // namespace ambient
