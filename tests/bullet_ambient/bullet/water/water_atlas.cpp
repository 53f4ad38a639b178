#include "tests/bullet_ambient/bullet/water/water_atlas.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/convergence.h"

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

}  // namespace ambient::test
