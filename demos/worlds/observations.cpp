#include "demos/worlds/observations.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "demos/simulation/robots/scene_robot.h"

namespace ambient {
namespace {

using View = const ObservationView&;

template <class Vector>
void put(const Vector& v, double* to) {
  for (Eigen::Index i = 0; i < v.size(); ++i) to[i] = v[i];
}

Vector3 inBody(View v, const Vector3& x_W) { return v.to_W.transpose() * x_W; }
Vector3 placeOf(View v) { return v.now.position + v.to_W * v.place; }

void readRotation(View v, double* to) {
  for (Eigen::Index i = 0; i < 9; ++i) to[i] = v.to_W(i / 3, i % 3);
}

void readHeading(View v, double* to) {
  const double x = v.to_W(0, 0), y = v.to_W(1, 0), length = portable::hypot(x, y);
  to[0] = length > 0 ? x / length : 1;
  to[1] = length > 0 ? y / length : 0;
}

void readImu(View v, double* to) {
  const Twist& now = v.now.twist;
  const Vector3 arm = v.to_W * v.place;
  Vector3 specific = -v.plan.scene.gravity + now.angular.cross(now.angular.cross(arm));
  if (v.before) {
    const double step = v.plan.scene.time_step;
    specific += (now.linear - v.before->linear) / step +
                ((now.angular - v.before->angular) / step).cross(arm);
  }
  put(inBody(v, now.angular), to);
  put(inBody(v, specific), to + 3);
}

void readDepth(View v, double* to) {
  const Vector3 place = placeOf(v);
  const double height = v.simulation.surfaceOver(place);
  to[0] = std::isfinite(height) ? height : -place.z();
}

void readWrench(View v, double* to) {
  const Wrench sum = v.simulation.wrench(v.field->body).total();
  put(inBody(v, sum.torque), to);
  put(inBody(v, sum.force), to + 3);
}

void readJoints(View v, double (Robot::*value)(const std::string&) const, double* to) {
  for (const BatchJoint& joint : v.plan.joints)
    *to++ = (v.simulation.robot(joint.robot).robot().*value)(joint.name);
}

const ObservationKind kKinds[] = {
    {"position", 3, [](View v, double* to) { put(v.now.position, to); }},
    {"orientation", 4,
     [](View v, double* to) {
       const Quaternion& q = v.now.orientation;
       put(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), to);
     }},
    {"rotation", 9, readRotation},
    {"up", 3, [](View v, double* to) { put(Vector3(v.to_W.row(2).transpose()), to); }},
    {"heading", 2, readHeading},
    {"twist", 6,
     [](View v, double* to) {
       put(inBody(v, v.now.twist.angular), to);
       put(inBody(v, v.now.twist.linear), to + 3);
     }},
    {"twist_world", 6, [](View v, double* to) { put(v.now.twist.vector(), to); }},
    {"imu", 6, readImu},
    {"velocity_log", 3,
     [](View v, double* to) {
       const Vector3 arm = v.to_W * v.place;
       put(inBody(v, v.now.twist.linear + v.now.twist.angular.cross(arm)), to);
     }},
    {"depth", 1, readDepth},
    {"flow", 3,
     [](View v, double* to) {
       put(inBody(v, v.simulation.mediumAround(v.field->body).velocity - v.now.twist.linear), to);
     }},
    {"target", 3, [](View v, double* to) { put(inBody(v, v.target - v.now.position), to); }},
    {"thrust", kPerThruster,
     [](View v, double* to) {
       for (const ThrusterState& thruster : v.simulation.thrusters().states())
         *to++ = thruster.load.thrust;
     }},
    {"turns", kPerThruster,
     [](View v, double* to) {
       for (const ThrusterState& thruster : v.simulation.thrusters().states())
         *to++ = thruster.drive;
     }},
    {"foil_angle", kPerFoil,
     [](View v, double* to) {
       const SceneFoils& foils = v.simulation.foils();
       for (std::size_t i = 0; i < foils.size(); ++i) *to++ = foils.angle(i);
     }},
    {"wet", 1, [](View v, double* to) { to[0] = v.simulation.wet(v.field->body).share; }},
    {"contact", 1, [](View v, double* to) { to[0] = v.simulation.contactImpulse(v.field->body); }},
    {"fluid_wrench", 6, readWrench},
    {"joint_position", kPerJoint, [](View v, double* to) { readJoints(v, &Robot::position, to); }},
    {"joint_velocity", kPerJoint, [](View v, double* to) { readJoints(v, &Robot::velocity, to); }},
    {"motor_effort", kPerJoint, [](View v, double* to) { readJoints(v, &Robot::motorEffort, to); }},
    {"parameters", kPerParameter,
     [](View v, double* to) { std::copy_n(v.parameters, v.plan.parameter_size, to); }},
    {"time", 1, [](View v, double* to) { to[0] = v.time_share; }},
};

}  // namespace

const ObservationKind* findObservation(const std::string& name) {
  for (const ObservationKind& kind : kKinds)
    if (name == kind.name) return &kind;
  return nullptr;
}

std::string observationNames() {
  std::string names;
  for (const ObservationKind& kind : kKinds)
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

}  // namespace ambient
