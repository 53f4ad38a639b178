#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "demos/scene/scene_parts.h"
#include "demos/scene/scene_water.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

/// Checks values and throws one line that names the file, the place, the value and the limit.
class Checker {
 public:
  Checker(const Scene& scene, std::string place)
      : file_(scene.file.string()), place_(std::move(place)) {}

  void require(bool holds, const std::string& key, double value, const std::string& limit) const {
    require(holds, key + " is " + number(value) + "; must be " + limit);
  }

  void require(bool holds, const std::string& sentence) const {
    if (!holds) raiseInputError(file_, place_, sentence);
  }

 private:
  std::string file_;
  std::string place_;
};

void checkTimes(const Scene& scene) {
  const Checker check(scene, "");
  check.require(scene.time_step <= scene.duration, "time_step", scene.time_step,
                "<= duration (" + number(scene.duration) + " s)");
  constexpr double kRounding = 1e-12;
  check.require(scene.output_step >= scene.time_step * (1 - kRounding), "output_step",
                scene.output_step, ">= time_step (" + number(scene.time_step) + " s)");
  constexpr double kMostSteps = 1e9;
  check.require(scene.duration / scene.time_step <= kMostSteps, "duration / time_step",
                scene.duration / scene.time_step, "<= 1e9 steps");
}

void checkMass(const BodyDef& body, const Checker& check) {
  if (body.mass > 0) return;
  const double speed = body.linear_velocity.norm();
  const double spin = body.angular_velocity.norm();
  check.require(speed == 0, "mass is 0, a static body, but linear_velocity is " + number(speed) +
                                " m/s; must be 0");
  check.require(spin == 0, "mass is 0, a static body, but angular_velocity is " + number(spin) +
                               " rad/s; must be 0");
  check.require(body.waterline_table == 0, "mass is 0, a static body, but waterline_table is " +
                                               std::to_string(body.waterline_table) +
                                               "; must be 0");
}

void checkInertia(const BodyDef& body, const Checker& check) {
  if (!body.inertia) return;
  check.require(body.mass > 0, "inertia is given, but mass is 0, a static body");
  const Eigen::Vector3d principal = symmetricEigen<3>(*body.inertia).values;
  const std::string moments = "inertia has the principal moments " + number(principal[0]) + ", " +
                              number(principal[1]) + ", " + number(principal[2]) + " kg m^2; ";
  constexpr double kRounding = 1e-9;
  check.require(principal[0] > kRounding * principal[2] && principal[2] > 0,
                moments + "all must be > 0");
  check.require(principal[2] <= (principal[0] + principal[1]) * (1 + kRounding),
                moments + "none may exceed the sum of the other two");
}

void checkMotion(const BodyDef& body, const Checker& check) {
  const double norm = body.orientation.norm();
  check.require(std::abs(norm - 1) <= kQuaternionTolerance, "orientation has norm " + number(norm) +
                                                                "; must be 1 within " +
                                                                number(kQuaternionTolerance));
  const double angle = body.attach.flow.separation_angle;
  check.require(angle >= kPi / 2 - kAngleTolerance && angle <= kPi + kAngleTolerance,
                "separation_angle", angle, "from pi/2 to pi");
}

// Returns the place of a body in the file, of a link that of its robot.
std::string placeOf(const Scene& scene, std::size_t body) {
  const auto& link = scene.bodies[body].link;
  return link ? "robots[" + std::to_string(link->robot) + "]"
              : "bodies[" + std::to_string(body) + "]";
}

void checkNames(const Scene& scene) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const std::string& name = scene.bodies[i].name;
    const Checker check(scene, placeOf(scene, i) + ".");
    check.require(name.find_first_of(",\"\n\r") == std::string::npos,
                  "name contains a comma, a quote or a line break");
    check.require(names.insert(name).second, "name \"" + name + "\" is used twice");
  }
}

bool isDynamicBody(const Scene& scene, const std::string& name) {
  for (const BodyDef& body : scene.bodies)
    if (body.name == name) return body.mass > 0;
  return false;
}

bool isBody(const Scene& scene, const std::string& name) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [&](const BodyDef& body) { return body.name == name && !body.link; });
}

void checkJoint(const Scene& scene, const JointDef& joint, const Checker& check) {
  bool moves = false;
  for (const std::string& name : joint.bodies) {
    check.require(isBody(scene, name), "bodies names \"" + name + "\", which no body is called");
    moves = moves || isDynamicBody(scene, name);
  }
  check.require(moves, "bodies are all static; one must have a mass > 0");
  check.require(joint.bodies.size() == 1 || joint.bodies[0] != joint.bodies[1],
                "bodies names \"" + joint.bodies[0] + "\" twice");
  if (joint.axis) check.require(joint.axis->norm() > 0, "axis is 0, 0, 0; must have a length > 0");
}

void checkFluids(const Scene& scene) {
  const Checker check(scene, "");
  check.require(!scene.water || scene.gravity.norm() > 0,
                "water is given, but gravity is 0, 0, 0; must have a length > 0");
  try {
    makeRegions(scene);
  } catch (const std::invalid_argument& error) {
    check.require(false, error.what());
  }
}

}  // namespace

void checkScene(const Scene& scene) {
  checkTimes(scene);
  checkFluids(scene);
  checkNames(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Checker check(scene, placeOf(scene, i) + " (" + scene.bodies[i].name + ") ");
    checkMass(scene.bodies[i], check);
    checkInertia(scene.bodies[i], check);
    checkMotion(scene.bodies[i], check);
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    checkJoint(scene, scene.joints[i], Checker(scene, "joints[" + std::to_string(i) + "]."));
}

}  // namespace ambient
