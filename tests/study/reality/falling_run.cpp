#include "tests/study/reality/falling_run.h"

#include <cmath>
#include <cstdio>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/simulation/simulation.h"

namespace ambient {
namespace {

const Vector3 kUp(0, 0, 1);

const char* nameOf(PressureLaw law) {
  return kPressureLawNames[static_cast<std::size_t>(law)].second;
}

Scene sceneOf(const FallingCase& c, PressureLaw law) {
  Scene scene;
  scene.name = c.family;
  scene.duration = c.duration;
  scene.time_step = c.time_step;
  scene.gravity = -c.gravity * kUp;
  scene.medium = c.medium;
  BodyDef body;
  body.name = c.name;
  body.shape.geometry = Sphere{1};  // it meets nothing
  body.mass = c.mass;
  body.orientation = rotationFromVector(c.tilt * kPi / 180 * Vector3::UnitY());
  body.linear_velocity = c.velocity;
  body.angular_velocity = c.spin;
  body.attach.medium = c.medium;
  body.attach.flow.roughness = c.roughness;
  body.attach.flow.law = law;
  scene.bodies = {body};
  return scene;
}

PreparedBody preparedOf(const FallingCase& c) {
  PreparedBody body;
  body.fluid_body = c.body;
  body.mass = c.mass;
  body.inertia = c.inertia.asDiagonal();
  return body;
}

/// Mean velocity over the second half.
Vector3 meanVelocity(const std::vector<MotionSample>& motion) {
  const MotionSample &from = motion[motion.size() / 2], &to = motion.back();
  return (to.position - from.position) / (to.time - from.time);
}

double meanSpin(const std::vector<MotionSample>& motion) {
  const std::size_t begin = motion.size() / 2;
  double sum = 0;
  for (std::size_t i = begin; i < motion.size(); ++i) sum += motion[i].twist.angular.y();
  return std::abs(sum) / static_cast<double>(motion.size() - begin);
}

/// Horizontal distance from the release at this depth; 0 if the body does not get there.
double reachAt(double depth, const std::vector<MotionSample>& motion) {
  for (const MotionSample& s : motion)
    if (depth > 0 && s.position.z() < -depth)
      return portable::hypot(s.position.x(), s.position.y());
  return 0;
}

}  // namespace

FallingRun runFall(const FallingCase& c, PressureLaw law) {
  Simulation simulation(sceneOf(c, law), {preparedOf(c)});
  const long steps = std::lround(c.duration / c.time_step);
  FallingRun run;
  for (long i = 0; i < steps; ++i) {
    simulation.step();
    run.motion.push_back(simulation.sample()[0]);
  }
  const std::vector<MotionSample> late(run.motion.begin() + steps / 2, run.motion.end());
  run.fall = analyseFall(late, kUp, -c.gravity * kUp);
  const AmbientCounters work = simulation.work(0);
  run.substeps = static_cast<double>(work.substeps) / static_cast<double>(steps);
  run.coarse = static_cast<double>(work.coarse) / static_cast<double>(steps);
  return run;
}

std::string fallHeader() {
  return "family,name,parameter,tilt,law,mode,descent,drift,spin,reach,miss,swing,substeps,"
         "coarse\n";
}

std::string fallLine(const FallingCase& c, PressureLaw law, const FallingRun& run) {
  const Vector3 velocity = meanVelocity(run.motion);
  char line[256];
  std::snprintf(line, sizeof line,
                "%s,\"%s\",%g,%g,%s,%s,%.4g,%.4g,%.4g,%.4g,%.4g,%.3g,%.3g,%.3g\n", c.family.c_str(),
                c.name.c_str(), c.parameter, c.tilt, nameOf(law),
                fallingModeName(run.fall.mode).c_str(), -velocity.z(),
                portable::hypot(velocity.x(), velocity.y()), meanSpin(run.motion),
                reachAt(c.depth, run.motion), (run.motion.back().position - c.end).norm(),
                run.fall.largest_swing * 180 / kPi, run.substeps, run.coarse);
  return line;
}

std::string pathHeader() { return "family,name,tilt,law,time,x,z,angle\n"; }

std::string pathLines(const FallingCase& c, PressureLaw law, const FallingRun& run) {
  constexpr std::size_t kEvery = 10;
  std::string lines;
  for (std::size_t i = 0; i < run.motion.size(); i += kEvery) {
    const MotionSample& s = run.motion[i];
    const Vector3 chord = s.orientation * Vector3::UnitX();
    char line[160];
    std::snprintf(line, sizeof line, "%s,%s,%g,%s,%.4g,%.5g,%.5g,%.4g\n", c.family.c_str(),
                  c.name.c_str(), c.tilt, nameOf(law), s.time, s.position.x(), s.position.z(),
                  portable::atan2(chord.z(), chord.x()));
    lines += line;
  }
  return lines;
}

}  // namespace ambient
