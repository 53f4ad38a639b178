#include "demos/python/motion.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"

namespace ambient {
namespace {

namespace py = pybind11;

py::array_t<double> notKnown(Motion::Shape shape, py::ssize_t components) {
  shape.push_back(components);
  py::array_t<double> array(shape);
  std::fill_n(array.mutable_data(), array.size(), std::numeric_limits<double>::quiet_NaN());
  return array;
}

}  // namespace

Motion::Motion(const Shape& shape)
    : position(notKnown(shape, 3)),
      orientation(notKnown(shape, 4)),
      twist(notKnown(shape, 6)),
      positions_(position.mutable_data()),
      orientations_(orientation.mutable_data()),
      twists_(twist.mutable_data()) {}

void Motion::set(std::size_t place, const MotionSample& sample) noexcept {
  const Quaternion& q = sample.orientation;
  Eigen::Map<Vector3>(positions_ + 3 * place) = sample.position;
  Eigen::Map<Eigen::Vector4d>(orientations_ + 4 * place) << q.w(), q.x(), q.y(), q.z();
  Eigen::Map<Vector6>(twists_ + 6 * place) = sample.twist.vector();
}

Motion motionOf(const std::vector<std::vector<MotionSample>>& samples) {
  const std::size_t bodies = samples.size(), times = samples.front().size();
  Motion motion({static_cast<py::ssize_t>(times), static_cast<py::ssize_t>(bodies)});
  motion.times = py::array_t<double>(static_cast<py::ssize_t>(times));
  for (std::size_t i = 0; i < times; ++i) {
    motion.times.mutable_data()[i] = samples.front()[i].time;
    for (std::size_t body = 0; body < bodies; ++body)
      motion.set(i * bodies + body, samples[body][i]);
  }
  return motion;
}

py::object componentsOf(const py::array& array, int begin, int end) {
  return array[py::make_tuple(py::ellipsis(), py::slice(begin, end, 1))];
}

py::object scalarLast(const py::array& quaternions) {
  const py::object order = py::cast(std::vector<int>{1, 2, 3, 0});
  return quaternions[py::make_tuple(py::ellipsis(), order)];
}

void bindMotion(py::module_& module) {
  py::class_<Motion>(module, "Motion",
                     "Motion of B bodies at T times, of N runs if it comes from a rollout.")
      .def_readonly("t", &Motion::times, "Times (T,) [s].")
      .def_readonly("position", &Motion::position,
                    "Positions (..., B, 3) of the centres of mass in world axes [m].")
      .def_readonly("orientation", &Motion::orientation,
                    "Unit quaternions (..., B, 4) w, x, y, z from the shape's axes to the world's.")
      .def_readonly("twist", &Motion::twist,
                    "Twists (..., B, 6): angular velocity [rad/s], then velocity of the centre of "
                    "mass [m/s], in world axes.")
      .def_property_readonly(
          "orientation_xyzw", [](const Motion& m) { return scalarLast(m.orientation); },
          "Unit quaternions (..., B, 4) x, y, z, w, the order of SciPy and PyBullet.")
      .def_property_readonly(
          "angular_velocity", [](const Motion& m) { return componentsOf(m.twist, 0, 3); },
          "View of the angular velocities (..., B, 3) [rad/s].")
      .def_property_readonly(
          "linear_velocity", [](const Motion& m) { return componentsOf(m.twist, 3, 6); },
          "View of the linear velocities (..., B, 3) [m/s].")
      .def("__repr__",
           [](const Motion& m) { return "<Motion of shape " + shapeText(m.position) + ">"; });
}

}  // namespace ambient
