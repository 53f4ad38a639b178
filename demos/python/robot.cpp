#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/python_world.h"

namespace ambient {
namespace {

namespace py = pybind11;

std::vector<std::string> jointNames(const PythonRobot& robot) {
  std::vector<std::string> names;
  for (const LinkModel& link : robot.get().robot().model().links)
    if (link.parent >= 0 && link.joint.isAxial()) names.push_back(link.joint.name);
  return names;
}

/// Returns `value` of each joint, in the order of jointNames().
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

Robot& changed(const PythonRobot& robot) {
  return robot.world->simulation().changedRobot(robot.index).robot();
}

void setPose(const PythonRobot& robot, const InputArray& position, const py::object& orientation) {
  Robot& moved = changed(robot);
  RigidPose pose = moved.linkPose(-1) * moved.model().links.front().joint.origin.inverse();
  pose.translation() = vectorFrom(position, "position");
  if (!orientation.is_none())
    pose.linear() = quaternionFrom(orientation.cast<InputArray>()).toRotationMatrix();
  moved.setPose(pose);
}

void setJoint(const PythonRobot& robot, const std::string& joint, std::optional<double> position,
              std::optional<double> velocity) {
  if (position) changed(robot).setPosition(joint, *position);
  if (velocity) changed(robot).setVelocity(joint, *velocity);
}

void bindMotion(py::class_<PythonRobot>& type) {
  type.def("set_pose", &setPose, py::arg("position"), py::arg("orientation") = py::none(),
           "Puts the root link's frame to a position (3,) [m], with an orientation (4,) w, x, y, "
           "z; default: the present one.")
      .def(
          "set_twist",
          [](const PythonRobot& r, const InputArray& twist) {
            changed(r).setTwist(twistFrom(twist));
          },
          py::arg("twist"),
          "Sets the twist (6,) of the root link: angular velocity [rad/s], then velocity of its "
          "centre of mass [m/s], world axes.")
      .def("set_joint", &setJoint, py::arg("joint"), py::kw_only(),
           py::arg("position") = py::none(), py::arg("velocity") = py::none(),
           "Sets position [rad] or [m] and velocity [rad/s] or [m/s] of a joint; default: as they "
           "are.");
}

void bindJoints(py::class_<PythonRobot>& type) {
  type.def_property_readonly("joints", &jointNames, "Names of the J revolute and prismatic joints.")
      .def_property_readonly(
          "joint_positions", [](const PythonRobot& r) { return ofJoints(r, &Robot::position); },
          "Positions (J,) in the order of joints [rad] or [m].")
      .def_property_readonly(
          "joint_velocities", [](const PythonRobot& r) { return ofJoints(r, &Robot::velocity); },
          "Velocities (J,) in the order of joints [rad/s] or [m/s].")
      .def_property_readonly(
          "motor_efforts", [](const PythonRobot& r) { return ofJoints(r, &Robot::motorEffort); },
          "Efforts (J,) of the motors in the last step [N m] or [N]; 0 without a motor.")
      .def("set_motor", &setMotor, py::arg("joint"), py::arg("position") = py::none(),
           py::arg("velocity") = py::none(), py::kw_only(),
           py::arg("effort") = std::numeric_limits<double>::infinity(),
           py::arg("position_gain") = 0.1, py::arg("velocity_gain") = 1.0,
           "Drives a joint to a position or at a velocity from now on, in place of the scene's "
           "motor. The effort is limited by `effort` and by the joint's own limit; 0 switches the "
           "motor off. Gains: share of the error that one step corrects.")
      .def(
          "apply_torque",
          [](const PythonRobot& r, const std::string& joint, double torque) {
            r.get().addJointTorque(joint, torque);
          },
          py::arg("joint"), py::arg("torque"),
          "Adds a torque [N m] or force [N] at a joint for one step. Limits of the joint's effort "
          "do not apply.")
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
          "Returns the wrench (6,) of the parent on the link in the last step: torque [N m] about "
          "the origin of the link's frame, then force [N], in world axes. Does not contain the "
          "effort of the joint's motor. Call measure() before.");
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
  bindMotion(type);
  type.def_property_readonly(
          "name", [](const PythonRobot& r) { return r.world->scene().robots[r.index].name; },
          "Name of the robot; its links are bodies NAME/LINK of the world.")
      .def(
          "pose",
          [](const PythonRobot& r, const std::string& link) {
            return arrayOf(r.get().robot().linkPose(link).matrix());
          },
          py::arg("link"),
          "Returns the matrix (4, 4) that maps coordinates in the frame of a link to the world's. "
          "Knows links, too, that a fixed joint has made part of another link.");
}

}  // namespace ambient
