#pragma once

#include <cmath>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/motion/surface/flotation.h"
#include "bullet_ambient/motion/surface/surface_flight.h"
#include "tests/support/bodies/body_models.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {

constexpr double kWaterDensity = 1000;
const SurfacePlane kStill{{0, 0, 1}, 0, 0, 0};

struct FloatingDef {
  FluidBody shape;
  double specific_gravity = 0.5;
  Vector3 gyration{0.4, 0.4, 0.4};  ///< radii of gyration about the centre of mass [m]
  Vector3 centre_of_mass{0, 0, 0};  ///< in F
  double gravity = 9.81;
  bool has_loads = false;
  double wave_damping = 1;
  Medium above{0, 0, {0, 0, 0}, {0, 0, 0}};
};

/// A body at the surface z = 0 of still water, below vacuum by default; advances step by step.
class FloatingRun {
 public:
  explicit FloatingRun(const FloatingDef& def) : gravity_(0, 0, -def.gravity) {
    SurfaceModelDef model;
    model.shape = std::make_shared<const FluidBody>(def.shape);
    mass_ = def.specific_gravity * kWaterDensity * def.shape.volume;
    model.mass = {mass_, (mass_ * def.gyration.cwiseAbs2()).asDiagonal()};
    model.fluid_frame.translation = -def.centre_of_mass;
    model.above = def.above;
    model.below = {kWaterDensity, 1e-3, {0, 0, 0}, {0, 0, 0}};
    if (!def.has_loads) model.flow.own_law = [](const auto&, const auto&) { return nullptr; };
    model.wave_damping = def.wave_damping;
    model_ = makeSurfaceModel(model);
    surroundings_.gravity = gravity_;
    surroundings_.applied.force = mass_ * gravity_;
  }

  RigidState state;
  FlightMemory memory;
  WaveMemory waves;
  FlightCount count;
  Vector3 velocity_above = Vector3::Zero();
  FlightSettings settings;
  std::vector<HoldState> water;  ///< in the holds of the body
  mutable VesselSloshing sloshing;
  double sloshing_damping = 0.03;

  const SurfaceModel& model() const { return model_; }
  Surroundings& surroundings() { return surroundings_; }
  double mass() const { return mass_; }

  void step(double duration) {
    if (sloshing.now.size() != water.size()) sloshing.resize(water.size());
    Flotation flotation = this->flotation();
    FlightResult body{state, memory, {}};
    SurfaceFlight flight{model_,   kStill,   surroundings_, velocity_above, settings,
                         duration, inside(), body,          waves,          flotation};
    SurfaceFlight* const flights[] = {&flight};
    flyAtSurface(flights, 1);
    state = body.state;
    memory = body.memory;
    count = body.count;
  }
  void run(double time, double duration) {
    const int steps = static_cast<int>(std::lround(time / duration));
    for (int i = 0; i < steps; ++i) step(duration);
  }

  Immersion immersion() const { return immersionOf(model_, plane_B()); }
  SurfacePlane plane_B() const {
    const Matrix3 R = state.orientation.toRotationMatrix();
    const SurfacePlane plane{{0, 0, 1}, 0, model_.excess_density, -gravity_.z()};
    return seenFrom(plane, R, state.position);
  }
  Flotation flotation() const { return flotationAt(model_, plane_B(), inside()); }
  Matrix6 inertia() const { return flotation().inertia.full(); }
  Vector3 velocity_W() const { return state.orientation * state.twist.linear; }
  Vector3 momentum_W() const {
    const Vector6 p = inertia() * state.twist.vector();
    return state.orientation * Vector3(p.tail<3>());
  }
  /// Energy of body, water and waves; docs/theory.md eq. (64).
  double energy() const {
    const Flotation at = flotation();
    const Vector6 x = state.twist.vector();
    return 0.5 * x.dot(at.inertia.full() * x) - mass_ * gravity_.dot(state.position) +
           hydrostaticEnergy(wetVolume(model_, at), at.plane) + waves.energy() +
           energyOfWater(at).sum();
  }
  /// Energy of the water in the holds as it sloshes [J].
  SloshingEnergy energyOfWater(const Flotation& at) const {
    if (!at.inside_F) return {};
    const WaterAt here{model_, at, state.orientation.toRotationMatrix(), state.position};
    std::vector<Sloshing> states = sloshing.now;
    states.resize(water.size());
    joinVessel(here.sloshing(), state.twist.vector(), states.data());
    return energyOfSloshing(here.sloshing(), states.data());
  }

 private:
  VesselWater inside() const {
    if (water.empty()) return {};
    modes_.emplace_back(water.size());
    return {water.data(), &inside_.emplace_back(), modes_.back().data(), &sloshing,
            sloshing_damping};
  }

  // One of each flotation that was given away.
  mutable std::deque<WaterInside> inside_;
  mutable std::deque<std::vector<HoldModes>> modes_;

  Vector3 gravity_;
  double mass_ = 0;
  SurfaceModel model_;
  Surroundings surroundings_;
};

/// Extreme of a sampled signal, without its first and last sample.
struct Extreme {
  double time, value;
};
inline std::vector<Extreme> extremesOf(const std::vector<double>& signal, double time_step) {
  std::vector<Extreme> extremes;
  for (std::size_t i = 1; i + 1 < signal.size(); ++i) {
    const double before = signal[i] - signal[i - 1], after = signal[i + 1] - signal[i];
    if (before * after > 0 || before == 0) continue;
    const double shift = before == after ? 0 : 0.5 * (before + after) / (before - after);
    extremes.push_back({time_step * (static_cast<double>(i) + shift),
                        signal[i] + 0.25 * shift * (before + after)});
  }
  return extremes;
}

}  // namespace ambient::test
