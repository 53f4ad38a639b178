#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "demos/scene/scene_parts.h"
#include "demos/scene/scene_water.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/robot/robot_model.h"

namespace ambient {
namespace {

using nlohmann::json;

JointDrive toDrive(const json& from, const std::string& place) {
  JointDrive drive;
  drive.position = from.value("position", drive.position);
  drive.amplitude = from.value("amplitude", drive.amplitude);
  drive.period = from.value("period", drive.period);
  drive.phase = from.value("phase", drive.phase);
  drive.effort = from.value("effort", drive.effort);
  drive.position_gain = from.value("position_gain", drive.position_gain);
  drive.velocity_gain = from.value("velocity_gain", drive.velocity_gain);
  if (from.contains("velocity")) drive.velocity = from.at("velocity").get<double>();
  if (drive.velocity && (from.contains("position") || from.contains("amplitude")))
    raiseInputError(place, "has a velocity and a position; must be one of them");
  return drive;
}

PackageFolders toPackages(const json& from, const std::filesystem::path& folder) {
  PackageFolders packages;
  if (from.contains("packages"))
    for (const auto& [name, path] : from.at("packages").items())
      packages[name] = folder / path.get<std::string>();
  return packages;
}

RobotModel readModel(const json& from, const std::filesystem::path& scene_file) {
  const std::filesystem::path folder = scene_file.parent_path();
  RobotModel model =
      readUrdf(folder / from.at("urdf").get<std::string>(), toPackages(from, folder));
  if (from.value("merge_fixed_links", true)) model = withoutFixedJoints(model);
  const bool fixed_base = from.value("fixed_base", false);
  checkRobot(model, fixed_base);
  return withCarriedCollisions(std::move(model), fixed_base);
}

/// Medium named by <ambient medium=.../>; none: that of the robot.
std::optional<Medium> namedMedium(const std::string& name) {
  if (name == "water") return water();
  if (name == "air") return air();
  return std::nullopt;
}

void readFlow(const json& from, PressureLaw law, FlowSettings& flow) {
  flow.law = lawOr(from, law);
  flow.separation_angle = from.value("separation_angle", flow.separation_angle);
  flow.roughness = from.value("roughness", flow.roughness);
  flow.skin_friction = from.value("skin_friction", flow.skin_friction);
}

/// Reads motors, joint positions and velocities; checks that the joints are revolute or prismatic.
/// A joint with a position motor starts at the motor's target, unless joint_positions names another
/// position.
void readJoints(const json& from, const std::string& place, RobotDef& robot) {
  const auto require_axial = [&](const std::string& key, const std::string& joint) {
    const auto index = static_cast<std::size_t>(robot.model->jointIndex(joint));
    if (!robot.model->links[index].joint.isAxial())
      raiseInputError(place + key, "joint \"", joint, "\" must be revolute or prismatic");
  };
  if (from.contains("motors"))
    for (const auto& [joint, motor] : from.at("motors").items()) {
      require_axial("motors", joint);
      const JointDrive drive = toDrive(motor, place + "motors." + joint);
      robot.motors[joint] = drive;
      if (!drive.velocity) robot.joint_positions[joint] = drive.positionAt(0);
    }
  const auto read = [&](const std::string& key, std::map<std::string, double>& numbers) {
    if (!from.contains(key)) return;
    for (const auto& [joint, number] : from.at(key).items()) {
      require_axial(key, joint);
      numbers[joint] = number.get<double>();
    }
  };
  read("joint_positions", robot.joint_positions);
  read("joint_velocities", robot.joint_velocities);
}

BodyDef toBody(const Scene& scene, const RobotDef& robot, std::size_t index,
               const RigidPose& pose) {
  const LinkModel& link = robot.model->links[index];
  BodyDef body;
  body.name = robot.name + "/" + link.name;
  body.mass = robot.fixed_base && link.parent < 0 ? 0 : link.mass;
  body.inertia = link.inertia;
  body.centre_of_mass = link.centre_of_mass;
  body.position = pose * link.centre_of_mass;
  body.orientation = Quaternion(Matrix3(pose.linear()));
  body.attach.flow = robot.flow;
  body.attach.medium = robot.medium.value_or(scene.medium);
  body.shape.source = robot.model->source + ": link \"" + link.name + "\"";
  if (body.mass == 0) body.inertia.reset();
  if (!link.fluid) return body;
  if (link.fluid->law) body.attach.flow.law = *link.fluid->law;
  if (link.fluid->roughness) body.attach.flow.roughness = *link.fluid->roughness;
  if (const auto medium = namedMedium(link.fluid->medium)) body.attach.medium = *medium;
  return body;
}

void addLinks(std::size_t index, Scene& scene) {
  const RobotDef& robot = scene.robots[index];
  const std::vector<RigidPose> poses = linkPoses(*robot.model, robot.pose(), robot.joint_positions);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (robot.model->links[i].collisions.empty()) continue;
    scene.bodies.push_back(toBody(scene, robot, i, poses[i]));
    scene.bodies.back().link = SceneLink{index, i};
  }
}

}  // namespace

double JointDrive::positionAt(double time) const {
  return position + amplitude * portable::sin(2 * kPi * time / period + phase);
}

double JointDrive::velocityAt(double time) const {
  if (velocity) return *velocity;
  const double rate = 2 * kPi / period;
  return amplitude * rate * portable::cos(rate * time + phase);
}

RigidPose RobotDef::pose() const {
  RigidPose pose = RigidPose::Identity();
  pose.linear() = orientation.normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

void addRobot(const json& from, Scene& scene) {
  const std::size_t index = scene.robots.size();
  const std::string place = scene.file.string() + ": robots[" + std::to_string(index) + "].";
  RobotDef robot;
  robot.name = from.value("name", "robot_" + std::to_string(index));
  robot.model = std::make_shared<const RobotModel>(readModel(from, scene.file));
  robot.position = vectorOr(from, "position", robot.position);
  robot.orientation = orientationIn(from);
  const double norm = robot.orientation.norm();
  if (!(std::abs(norm - 1) <= kQuaternionTolerance))
    raiseInputError(place + "orientation", "has norm ", norm, "; must be 1 within ",
                    kQuaternionTolerance);
  robot.orientation.normalize();
  robot.linear_velocity = vectorOr(from, "linear_velocity", Vector3::Zero());
  robot.angular_velocity = vectorOr(from, "angular_velocity", Vector3::Zero());
  robot.fixed_base = from.value("fixed_base", false);
  robot.self_collision = from.value("self_collision", false);
  if (from.contains("medium")) robot.medium = toMedium(from.at("medium"), Medium{});
  readFlow(from, scene.law, robot.flow);
  readJoints(from, place, robot);
  scene.robots.push_back(std::move(robot));
  addLinks(index, scene);
}

}  // namespace ambient
