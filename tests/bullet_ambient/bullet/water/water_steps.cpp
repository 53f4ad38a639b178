#include "tests/bullet_ambient/bullet/water/water_steps.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "tests/bullet_ambient/bullet/water/water_run.h"
#include "tests/support/floating_runs.h"

namespace ambient::test {
namespace {

constexpr double kHertz[] = {30, 60, 120, 240};
constexpr double kReferenceHertz = 7680;
constexpr std::size_t kExtremes = 4;

int stepsOf(double time, double step) { return static_cast<int>(std::lround(time / step)); }

double heightOf(const btRigidBody& body) { return readState(body).position.z(); }
// Tilt of the axis that is upright at rest [rad].
double tiltOf(const btRigidBody& body) {
  const Vector3 up = readState(body).orientation.conjugate() * Vector3::UnitZ();
  return std::atan2(up.y(), up.z());
}

WaterBodyDef bodyOf(WaterShape shape, double size, double specific_gravity, int max_substeps) {
  WaterBodyDef def;
  def.shape = shape;
  def.size = size;
  def.specific_gravity = specific_gravity;
  def.max_substeps = max_substeps;
  return def;
}

std::vector<double> passSurface(double height, double time, double specific_gravity, double step,
                                int max_substeps) {
  WaterBodyDef def = bodyOf(WaterShape::kCube, 0.5, specific_gravity, max_substeps);
  def.start.position.z() = height;
  def.start.orientation = Quaternion(Eigen::AngleAxisd(0.35, Vector3(1, 0.3, 0).normalized()));
  WaterRun run(Around::kWater);
  const btRigidBody& body = run.add(def);
  for (int i = 0; i < stepsOf(time, step); ++i) run.step(step);
  return {heightOf(body), tiltOf(body)};
}

/// First extremes of a signal of the body, over its initial value.
template <class Signal>
std::vector<double> decay(const WaterBodyDef& def, double time, double step, const Signal& signal) {
  WaterRun run(Around::kWater);
  const btRigidBody& body = run.add(def);
  const double start = signal(body);
  std::vector<double> samples{1};
  for (int i = 0; i < stepsOf(time, step); ++i) {
    run.step(step);
    samples.push_back(signal(body) / start);
  }
  std::vector<double> values;
  for (const Extreme& extreme : extremesOf(samples, step)) values.push_back(extreme.value);
  values.resize(kExtremes);
  return values;
}

std::vector<double> heave(double step, int max_substeps) {
  WaterBodyDef def = bodyOf(WaterShape::kBall, 0.3, 0.5, max_substeps);
  def.separation_angle = kPi;
  def.start.position.z() = 0.03;
  return decay(def, 2.4, step, heightOf);
}

std::vector<double> roll(double step, int max_substeps) {
  WaterBodyDef def = bodyOf(WaterShape::kBox, 1, 0.5, max_substeps);
  def.separation_angle = kPi;
  def.start.orientation = Quaternion(Eigen::AngleAxisd(kPi / 36, Vector3::UnitX()));
  return decay(def, 8, step, tiltOf);
}

// First harmonic of the last five of 20 periods.
std::vector<double> ride(double step, int max_substeps) {
  constexpr double kPeriod = 2, kAmplitude = 0.05;
  const auto waves = std::make_shared<AiryWaves>(
      CalmSea{}, std::vector<WaveComponent>{{kAmplitude, kPeriod, {1, 0, 0}, 0}});
  WaterRun run(waves);
  WaterBodyDef def = bodyOf(WaterShape::kBox, 1, 0.5, max_substeps);
  def.separation_angle = kPi;
  const btRigidBody& body = run.add(def);
  const int steps = stepsOf(20 * kPeriod, step), from = stepsOf(15 * kPeriod, step);
  double cosine = 0, sine = 0;
  for (int i = 1; i <= steps; ++i) {
    run.step(step);
    if (i <= from) continue;
    const double phase = 2 * kPi * i * step / kPeriod;
    cosine += heightOf(body) * std::cos(phase);
    sine += heightOf(body) * std::sin(phase);
  }
  return {2 * std::hypot(cosine, sine) / (steps - from) / kAmplitude};
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

const char* nameOf(WaterMotion motion) {
  constexpr const char* kNames[] = {"entry of a cube", "exit of a cube", "heave decay of a ball",
                                    "roll decay of a box", "heave of a box in a wave"};
  return kNames[static_cast<std::size_t>(motion)];
}

std::vector<double> runMotion(WaterMotion motion, double step, int max_substeps) {
  switch (motion) {
    case WaterMotion::kEntry:
      return passSurface(1.4, 0.8, 0.5, step, max_substeps);
    case WaterMotion::kExit:
      return passSurface(-1.5, 0.9, 0.3, step, max_substeps);
    case WaterMotion::kHeave:
      return heave(step, max_substeps);
    case WaterMotion::kRoll:
      return roll(step, max_substeps);
    case WaterMotion::kWave:
      break;
  }
  return ride(step, max_substeps);
}

StepErrors measureSteps(WaterMotion motion, int max_substeps) {
  const std::vector<double> reference = runMotion(motion, 1 / kReferenceHertz, 1);
  StepErrors errors;
  for (const double hertz : kHertz)
    errors.deviations.push_back(
        largestDifference(runMotion(motion, 1 / hertz, max_substeps), reference));
  errors.order = std::log2(errors.deviations[0] / errors.deviations[3]) / 3;
  return errors;
}

}  // namespace ambient::test
