#include "demos/python/robot.h"

#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"

namespace ambient {
namespace {

namespace py = pybind11;

std::vector<std::string> jointNames(const PythonRobot& robot) {
  std::vector<std::string> names;
  for (const LinkModel& link : robot.get().robot().model().links)
    if (link.parent >= 0 && link.joint.isAxial()) names.push_back(link.joint.name);
  return names;
}

/// One number of each joint, in the order of jointNames().
py::array ofJoints(const PythonRobot& robot, double (Robot::*value)(const std::string&) const) {
  const std::vector<std::string> names = jointNames(robot);
  Eigen::VectorXd values(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = (robot.get().robot().*value)(names[i]);
  return arrayOf(values);
}

void setMotor(const PythonRobot& robot, const std::string& joint, std::optional<double> position,
              std::optional<double> velocity, double effort, double position_gain,
              double velocity_gain) {
  if (position.has_value() == velocity.has_value())
    throw py::value_error("the motor of joint \"" + joint +
                          "\": must have a position or a velocity, one of them");
  JointDrive drive;
  drive.position = position.value_or(0);
  drive.velocity = velocity;
  drive.effort = effort;
  drive.position_gain = position_gain;
  drive.velocity_gain = velocity_gain;
  robot.get().setDrive(joint, drive);
}

void bindJoints(py::class_<PythonRobot>& type) {
  type.def_property_readonly("joints", &jointNames,
                             "Names of the revolute and prismatic joints, J of them.")
      .def_property_readonly(
          "joint_positions", [](const PythonRobot& r) { return ofJoints(r, &Robot::position); },
          "(J,), in the order of joints [rad] or [m]")
      .def_property_readonly(
          "joint_velocities", [](const PythonRobot& r) { return ofJoints(r, &Robot::velocity); },
          "(J,) [rad/s] or [m/s]")
      .def_property_readonly(
          "motor_efforts", [](const PythonRobot& r) { return ofJoints(r, &Robot::motorEffort); },
          "(J,), what the motors used in the last step [N m] or [N]; 0 without one")
      .def("set_motor", &setMotor, py::arg("joint"), py::arg("position") = py::none(),
           py::arg("velocity") = py::none(), py::kw_only(),
           py::arg("effort") = std::numeric_limits<double>::infinity(),
           py::arg("position_gain") = 0.1, py::arg("velocity_gain") = 1.0,
           "Drives a joint to a position, or by a velocity, from now on, in place of the scene's "
           "motor; effort 0: no longer. The effort is at most the joint's. Gains are shares of the "
           "error that a step makes good.")
      .def(
          "apply_torque",
          [](const PythonRobot& r, const std::string& joint, double torque) {
            r.get().addJointTorque(joint, torque);
          },
          py::arg("joint"), py::arg("torque"),
          "Adds a torque [N m] or force [N] at a joint for one step; limits of effort do not "
          "count.")
      .def(
          "measure", [](const PythonRobot& r, const std::string& joint) { r.get().measure(joint); },
          py::arg("joint"),
          "Computes the wrench in a joint, of any kind, in each step from now on.")
      .def(
          "joint_wrench",
          [](const PythonRobot& r, const std::string& joint) {
            return arrayOf(r.get().jointWrench(joint).vector());
          },
          py::arg("joint"),
          "(6,), torque [N m] about the origin of the link's frame, then force [N], of the parent "
          "on the link in the last step; world axes. The motor's own effort is not in it.");
}

}  // namespace

void bindRobot(py::module_& module) {
  py::class_<PythonRobot> type(module, "Robot",
                               R"(One robot of a world: its joints, motors and sensors.

>>> arm = World(Scene("underwater_arm")).robots["arm"]
>>> arm.joints
['yaw', 'shoulder', 'elbow']
)");
  bindJoints(type);
  type.def_property_readonly(
          "name", [](const PythonRobot& r) { return r.world->scene().robots[r.index].name; },
          "Bodies of the world are called NAME/LINK.")
      .def(
          "pose",
          [](const PythonRobot& r, const std::string& link) {
            return arrayOf(r.get().robot().linkPose(link).matrix());
          },
          py::arg("link"),
          "(4, 4), from coordinates in the frame of a link to the world's; also of a link that a "
          "fixed joint has made part of another.");
}

}  // namespace ambient
