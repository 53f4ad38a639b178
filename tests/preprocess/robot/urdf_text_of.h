#pragma once

#include <string>

#include "preprocess/robot/robot_model.h"

namespace ambient {

inline std::string inRobot(const std::string& content) {
  return "<robot name=\"r\">" + content + "</robot>";
}

/// Text of a link of 2 kg; moments of inertia 0.1, 0.2 and 0.25 kg m^2 along its own axes.
inline std::string massiveLink(const std::string& name, const std::string& more = "") {
  return "<link name=\"" + name + "\"><inertial><mass value=\"2\"/>" +
         R"(<inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>)" + more +
         "</link>";
}

inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/>" + more + "</joint>";
}

inline RobotModel parseRobot(const std::string& content) {
  return parseUrdf(inRobot(content), "r.urdf");
}

}  // namespace ambient
