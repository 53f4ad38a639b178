#include "tests/bullet_ambient/bullet/water/water_atlas.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "tests/bullet_ambient/bullet/water/water_run.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/convergence.h"
#include "tests/support/floating_runs.h"

namespace ambient::test {
namespace {

double logarithmic(Arbitrary& arbitrary, double low, double high) {
  return std::exp(arbitrary.between(std::log(low), std::log(high)));
}

WaterBodyDef anyBody(Arbitrary& arbitrary, double size) {
  WaterBodyDef def;
  def.shape = static_cast<WaterShape>(static_cast<int>(arbitrary.between(0, kWaterShapes)));
  def.size = size;
  def.specific_gravity = logarithmic(arbitrary, 0.02, 20);
  const double speed = std::sqrt(kGravity * size) * logarithmic(arbitrary, 0.03, 3);
  def.start.position.z() = arbitrary.between(-2, 2) * size;
  def.start.orientation = Quaternion(arbitrary.rotation());
  def.start.twist = arbitrary.twist(speed / size, speed);
  def.law = arbitrary.between(0, 1) < 0.5 ? PressureLaw::kForm : PressureLaw::kPublished;
  if (arbitrary.between(0, 1) < 0.5) def.separation_angle = kPi;
  return def;
}

// Random joint at a point of the first body's frame; a hinge has its axis along z.
std::unique_ptr<btTypedConstraint> anyJoint(Arbitrary& arbitrary, btRigidBody& body,
                                            const btVector3& point, btRigidBody* other) {
  const bool is_hinge = arbitrary.between(0, 1) < 0.5;
  const btTransform& pose = body.getWorldTransform();
  if (!other) {
    if (is_hinge) return std::make_unique<btHingeConstraint>(body, point, btVector3(0, 0, 1));
    return std::make_unique<btPoint2PointConstraint>(body, point);
  }
  const btTransform to_other = other->getWorldTransform().inverse() * pose;
  if (!is_hinge)
    return std::make_unique<btPoint2PointConstraint>(body, *other, point, to_other * point);
  return std::make_unique<btHingeConstraint>(body, *other, point, to_other * point,
                                             btVector3(0, 0, 1),
                                             to_other.getBasis() * btVector3(0, 0, 1));
}

// Random second body beside the first one, without overlap.
WaterBodyDef anySecond(Arbitrary& arbitrary, const WaterBodyDef& first, double gap) {
  WaterBodyDef def = anyBody(arbitrary, first.size * logarithmic(arbitrary, 0.5, 2));
  const double angle = arbitrary.between(0, 2 * kPi);
  const double way = kWaterShapeRadius * (first.size + def.size) + gap * first.size;
  def.start.position = first.start.position + way * Vector3(std::cos(angle), std::sin(angle), 0);
  return def;
}

// Adds seven bodies; with the first one they make the corners of a cube.
void addPile(Arbitrary& arbitrary, const WaterBodyDef& first, WaterRun& run) {
  for (int corner = 1; corner < 8; ++corner) {
    WaterBodyDef def = anyBody(arbitrary, first.size * logarithmic(arbitrary, 0.5, 1));
    const double way = 2.1 * kWaterShapeRadius * first.size;
    def.start.position =
        first.start.position + way * Vector3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    run.add(def);
  }
}

void tether(Arbitrary& arbitrary, btRigidBody& body, double radius, WaterRun& run) {
  const Vector3 point = radius * arbitrary.vector().normalized();
  run.join(anyJoint(arbitrary, body, toBullet(point), nullptr));
}

WaterRun makeRun(const WaterCase& water_case, Arbitrary& arbitrary) {
  if (water_case.setting != WaterSetting::kSteep || water_case.around == Around::kVacuum)
    return WaterRun(water_case.around);
  // Waves break at a height of 0.142 wavelengths.
  const double length = logarithmic(arbitrary, 0.5, 20);
  WaveComponent wave;
  wave.amplitude = 0.9 * 0.142 * length / 2;
  wave.period = std::sqrt(2 * kPi * length / kGravity);
  return WaterRun(std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{wave}));
}

void addBodies(Arbitrary& arbitrary, WaterSetting setting, WaterRun& run) {
  WaterBodyDef def = anyBody(arbitrary, logarithmic(arbitrary, 0.05, 5));
  const double radius = kWaterShapeRadius * def.size, gap = 0.2 * def.size;
  if (setting == WaterSetting::kTabled) def.shape = WaterShape::kBall;
  if (setting == WaterSetting::kOnFloor || setting == WaterSetting::kSteep) {
    const double floor = -arbitrary.between(0, 2) * def.size;
    def.start.position.z() = floor + radius + arbitrary.between(0, 2) * def.size;
    run.addPlane({0, 0, 1}, floor);
  }
  if (setting == WaterSetting::kAtWall) {
    def.start.twist.linear.x() = std::abs(def.start.twist.linear.x());
    run.addPlane({-1, 0, 0}, -radius - gap);
  }
  btRigidBody& body = run.add(def);
  if (setting == WaterSetting::kColliding) {
    WaterBodyDef second = anySecond(arbitrary, def, 0.2);
    const Vector3 way = (second.start.position - def.start.position).normalized();
    const double speed = arbitrary.between(1, 4) * std::sqrt(kGravity * def.size);
    second.start.twist.linear = def.start.twist.linear - speed * way;
    run.add(second);
  }
  if (setting == WaterSetting::kJoined) {
    WaterBodyDef second = anySecond(arbitrary, def, 0);
    btRigidBody& other = run.add(second);
    const Vector3 way = (second.start.position - def.start.position).normalized();
    const Vector3 point = def.start.orientation.conjugate() * (radius * way);
    run.join(anyJoint(arbitrary, body, toBullet(point), &other));
  }
  if (setting == WaterSetting::kTethered || setting == WaterSetting::kTabled)
    tether(arbitrary, body, radius, run);
  if (setting == WaterSetting::kPile) addPile(arbitrary, def, run);
  if (setting == WaterSetting::kSteep) run.add(anySecond(arbitrary, def, 0.2));
}

}  // namespace

const char* nameOf(WaterSetting setting) {
  constexpr const char* kNames[] = {"free",
                                    "onto a floor",
                                    "against a wall",
                                    "two that collide",
                                    "two on a joint",
                                    "on a joint to the world",
                                    "a pile of eight",
                                    "with a table, on a joint",
                                    "two over a floor in steep waves"};
  return kNames[static_cast<std::size_t>(setting)];
}

WaterResult runWater(const WaterCase& water_case) {
  Arbitrary arbitrary(water_case.seed);
  const int step = static_cast<int>(arbitrary.between(0, kAtlasSteps));
  const double hertz = kAtlasHertz[step];
  const bool has_energy =
      water_case.setting != WaterSetting::kSteep || water_case.around == Around::kVacuum;
  WaterRun run = makeRun(water_case, arbitrary);
  addBodies(arbitrary, water_case.setting, run);
  EnergyRise rise(run.energy());
  for (int i = 0; i < std::lround(kWaterAtlasTime * hertz) && !run.isDeep(); ++i) {
    run.step(1 / hertz);
    const double energy = run.energy();
    if (!std::isfinite(energy)) return {step, false, 0, 0};
    if (has_energy) rise.see(energy);
  }
  return {step, run.counters().rejected == 0, rise.overEarlier() / run.energyScale(),
          rise.overStart() / run.energyScale()};
}

void WaterTally::add(const WaterResult& result) {
  ++runs;
  not_finite += !result.is_finite;
  rose += result.over_earlier > 1e-3;
  rose_much += result.over_earlier > 1e-2;
  over_start = std::max(over_start, result.over_start);
  double& over_earlier_there = over_earlier[result.step];
  over_earlier_there = std::max(over_earlier_there, result.over_earlier);
}

WaterTable runWaters(int runs, unsigned seed) {
  WaterTable table;
  for (int s = 0; s < kWaterSettings; ++s)
    for (int a = 0; a < 2; ++a)
      for (int i = 0; i < runs; ++i)
        table[s][a].add(runWater({static_cast<WaterSetting>(s), static_cast<Around>(a),
                                  seed + static_cast<unsigned>(i)}));
  return table;
}

namespace {

constexpr double kHertz[] = {30, 60, 120, 240};
constexpr double kReferenceHertz = 7680;
constexpr std::size_t kExtremes = 4;

int stepsOf(double time, double step) { return static_cast<int>(std::lround(time / step)); }

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

std::vector<double> applyAddedMassChange(double height, double time, double specific_gravity,
                                         double step, int max_substeps) {
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
      return applyAddedMassChange(1.4, 0.8, 0.5, step, max_substeps);
    case WaterMotion::kExit:
      return applyAddedMassChange(-1.5, 0.9, 0.3, step, max_substeps);
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
