#include "bullet_ambient/immersed/vessel_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bullet_ambient/immersed/flow_along.h"
#include "bullet_ambient/motion/surface/hold_exchange.h"

namespace ambient {
void findRimWaves(AmbientBody& ambient, const MotionView& now,
                  const FluidRegions& regions) noexcept {
  VesselState& vessel = *ambient.vessel;
  if (!vessel.waves) return;
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane& plane_W = ambient.floating->plane_W;
  const Matrix3 R = now.rotation(), R_WF = R * model.fluid_frame.rotation;
  const Vector3 origin_W = now.centre() + R * model.fluid_frame.translation;
  const Vector3 up = -now.gravity.normalized();
  // Waves may reach an opening that is near to the plane: their slope is below 1.
  const auto isNear = [&](const OpeningShape::Edge& edge) {
    return std::abs(vessel.plane_F.depth(edge.middle)) < model.radius;
  };
  // Height of the surface over the plane at a place, along its normal; 0 where it is not finite.
  const auto riseAt = [&](const OpeningShape::Edge& edge) {
    const Vector3 place_W = origin_W + R_WF * edge.middle;
    RegionCall call(regions);
    const RegionSample sample =
        sampleRegion(*vessel.waves, place_W, regions.time, ambient.def->medium);
    if (!sample.is_finite) return 0.0;
    return plane_W.normal.dot(place_W + sample.height * up) - plane_W.height;
  };
  forEachOpening(*model.holds, &vessel.changes,
                 [&](const HoldShapes::Opening& opening, std::size_t number) {
                   std::vector<double>& rises = vessel.rises[number];
                   const auto& edges = opening.shape.edges();
                   std::fill(rises.begin(), rises.end(), 0.0);
                   if (opening.to >= 0 || std::none_of(edges.begin(), edges.end(), isNear)) return;
                   for (std::size_t i = 0; i < rises.size(); ++i) rises[i] = riseAt(edges[i]);
                 });
}

const HoldAround* holdAround(const AmbientBody& ambient, const FluidRegions& regions,
                             const FluidRegions::Entry& entry) noexcept {
  if (ambient.in_hold < 0 || !entry.region.surface) return nullptr;
  const HoldAround& around = regions.in_holds[static_cast<std::size_t>(ambient.in_hold)];
  return around.region == entry.id ? &around : nullptr;
}

void replaceSurfaceByHold(const HoldAround& around, const AmbientBody& ambient,
                          const MotionView& now, RegionSample& sample) noexcept {
  constexpr double kFar = 100;  // sizes of vessel and body
  const Vector3 place = now.centre();
  const double rise = -around.normal_W.dot(now.gravity) / now.gravity.norm();
  sample.height = !around.is_dry && rise > 0
                      ? (around.height - around.normal_W.dot(place)) / rise
                      : -kFar * (around.size + ambient.metric().reference_length);
  const Vector3 velocity =
      around.vessel_W.linear + around.vessel_W.angular.cross(place - around.centre_W);
  for (Medium* medium : {&sample.below, &sample.above}) {
    medium->velocity = velocity;
    medium->acceleration.setZero();
  }
  sample.tilt.setZero();
}

void warnOfSunkVessel(AmbientBody& ambient, Warnings& warnings) noexcept {
  constexpr double kFull = 1 - 1e-9;  // of a hold
  VesselState& vessel = *ambient.vessel;
  if (vessel.has_sunk) return;
  const SurfaceModel& model = *ambient.surface();
  double water = 0;
  std::size_t filled = vessel.holds.size();
  for (std::size_t i = 0; i < vessel.holds.size(); ++i) {
    const HoldState& hold = vessel.holds[i];
    water += hold.volume;
    if (hold.change > 0 && hold.volume >= kFull * vessel.shape->holds[i].volume) filled = i;
  }
  if (filled == vessel.holds.size()) return;
  const double most = model.excess_density * (vessel.shape->volume - water);
  vessel.has_sunk = model.above.mass - model.above.displaced_mass > most;
  if (vessel.has_sunk) warnings.warnOfSunkVessel(*ambient.def, filled);
}

void meetSurface(AmbientBody& ambient, const NearSurface& near,
                 const FluidRegion& region) noexcept {
  VesselState& vessel = *ambient.vessel;
  vessel.waves = nullptr;
  if (near.media < 0) return;
  const SurfaceModel& model = ambient.models->surfaces[static_cast<std::size_t>(near.media)].model;
  vessel.plane_F = seenFrom(near.plane_B, model.fluid_frame);
  vessel.waves = isLargeAgainstWaves(region, 2 * model.radius) ? &region : nullptr;
  if (std::exchange(vessel.is_known, true) || !ambient.def->holds.are_open) return;
  fillCoveredHolds(*model.holds, &vessel.changes, vessel.plane_F, vessel.holds.data());
}

namespace {

// Returns a body with water in its holds at its flotation.
WaterAt waterAt(const AmbientBody& ambient, const Matrix3& to_world, const Vector3& position_W) {
  return {*ambient.surface(), ambient.flotation(), to_world, position_W};
}

// Lets water that has not sloshed yet begin, and finds its energy.
void beginSloshing(AmbientBody& ambient, const Matrix3& to_world, const Vector6& x) {
  VesselState& vessel = *ambient.vessel;
  vessel.sloshing_energy = 0;
  if (!ambient.flotation().inside_F) return;
  Sloshing* const states = vessel.sloshing.now.data();
  const SloshingAt at = waterAt(ambient, to_world, {0, 0, 0}).sloshing();
  joinVessel(at, x, states);
  vessel.sloshing_energy = energyOfSloshing(at, states).sum();
}

// Takes the sloshing to the water that is there after some has passed. `energy`: of all that moves,
// before it [J].
void mixWater(AmbientBody& ambient, const Matrix3& to_world, const Vector6& x, double energy) {
  VesselState& vessel = *ambient.vessel;
  vessel.sloshing_energy = 0;
  Sloshing* const states = vessel.sloshing.now.data();
  if (!ambient.flotation().inside_F) {
    std::fill(states, states + vessel.holds.size(), Sloshing{});
    return;
  }
  const SloshingAt at = waterAt(ambient, to_world, {0, 0, 0}).sloshing();
  mixSloshing(vessel.holds.data(), vessel.sloshing.later.data(), at, x, states);
  vessel.sloshing_energy = projectOnModes(at, energy, states);
}

// Brings a vessel to the flotation with the water that has passed. `come`: exchangeWater() of
// holds.
void takeWater(AmbientBody& ambient, const Matrix3& to_world, const Vector6& x,
               const Matrix6& come) {
  VesselState& vessel = *ambient.vessel;
  const SurfaceModel& model = *ambient.surface();
  const Flotation& flotation = ambient.flotation();
  if (vessel.waves_inside.is_any)
    vessel.sloshing_energy -= loseSlopped(flotation.plane.density * flotation.plane.gravity,
                                          vessel.waves_inside, vessel.sloshing.now.data());
  const double twice_before = x.dot(flotation.inertia.full() * x) + 2 * vessel.sloshing_energy;
  vessel.sloshing.later = vessel.sloshing.modes;  // before water has passed
  ambient.floating->is_valid = false;
  AmbientBody* const body = &ambient;
  completeFlotationsOf(&body, 1);
  mixWater(ambient, to_world, x, twice_before / 2);
  const Matrix6 come_B = model.excess_density * model.fluid_frame.inertiaToB(come);
  const Vector6 end = x - flotation.inverse.full() * (come_B * x);
  const double most = std::max(0.0, twice_before - 2 * vessel.sloshing_energy);
  vessel.change_B = scaledWithin(end, end.dot(flotation.inertia.full() * end), most).twist - x;
}

// Change of the velocity in B by the drag of the bodies in the holds, which no more than carries
// the vessel along.
Vector6 kickByContents(const AmbientBody& ambient, const Matrix3& to_world, double duration) {
  const VesselState& vessel = *ambient.vessel;
  if (!(vessel.reaction_speed > 0)) return Vector6::Zero();
  const Wrench& push = vessel.reaction_W;
  const Vector6 kick =
      duration * (ambient.flotation().inverse.full() *
                  stack(to_world.transpose() * push.torque, to_world.transpose() * push.force));
  const double speed = kick.tail<3>().norm();
  return speed > vessel.reaction_speed ? vessel.reaction_speed / speed * kick : kick;
}

// Ends the step of a hold that is empty and stays so.
void stayDry(HoldState& hold) {
  hold.change = hold.inflow = 0;
  hold.is_sealed = false;
}

// True if the water in a vessel sloshes so little that the vessel may sleep.
bool isNearlyLevel(const AmbientBody& ambient) {
  constexpr double kLittle = 1e-6;  // of the water's weight times the size of the vessel
  double volume = 0;
  for (const HoldState& hold : ambient.vessel->holds) volume += hold.volume;
  const SurfaceModel& model = *ambient.surface();
  const double weight = model.excess_density * volume * ambient.flotation().plane.gravity;
  return ambient.vessel->sloshing_energy <= kLittle * weight * model.radius;
}

}  // namespace

bool exchangeWater(AmbientBody& ambient, const MotionView& now, double duration) noexcept {
  constexpr double kStill = 1e-9;  // of a hold
  VesselState& vessel = *ambient.vessel;
  const SurfaceModel& model = *ambient.surface();
  const HoldSettings& settings = ambient.def->holds;
  ExchangeStep step{settings.are_open, duration, settings.atmosphere, &vessel.changes,
                    vessel.waves ? &vessel.rises : nullptr};
  vessel.change_B.setZero();
  if (staysDry(*model.holds, vessel.plane_F, step, vessel.holds.data())) {
    for (HoldState& hold : vessel.holds) stayDry(hold);
    vessel.sloshing_energy = 0;  // setWater() may have emptied a hold
    return false;
  }
  const Flotation& flotation = flotationNow(ambient, now);
  const Vector6 x = twistInWater(ambient, now.state);
  const Matrix3 R = now.rotation();
  beginSloshing(ambient, R, x);
  vessel.waves_inside.is_any = false;
  if (flotation.inside_F) {
    step.modes = vessel.sloshing.modes.data();
    findWavesInside(waterAt(ambient, R, {0, 0, 0}), &vessel.changes, vessel.sloshing.now.data(),
                    vessel.waves_inside);
    if (vessel.waves_inside.is_any) step.waves = &vessel.waves_inside;
  }
  const Matrix6 come =
      exchangeWater(*model.holds, flotation.immersion_F.plane, step, vessel.holds.data());
  bool has_changed = false;
  for (std::size_t i = 0; i < vessel.holds.size(); ++i) {
    HoldState& hold = vessel.holds[i];
    has_changed = has_changed || hold.change != 0;
    (hold.inflow > 0 ? hold.flooded : hold.drained) += std::abs(hold.inflow);
    if (std::abs(hold.change) > kStill * vessel.shape->holds[i].volume) ambient.may_rest = false;
  }
  if (has_changed) takeWater(ambient, R, x, come);
  vessel.change_B += kickByContents(ambient, R, duration);
  if (!isNearlyLevel(ambient)) ambient.may_rest = false;
  return has_changed;
}

double sloshingEnergyNow(const AmbientBody& ambient, const MotionView& now) {
  if (!ambient.vessel || !ambient.surface()) return 0;
  std::vector<Sloshing> states = ambient.vessel->sloshing.now;
  std::vector<HoldModes> modes(states.size());
  WaterInside inside;
  const SurfacePlace place = placeAt(*ambient.surface(), planeAt(ambient, now.state),
                                     {waterOf(ambient), &inside, modes.data()});
  if (!place.inside_F) return 0;
  const WaterAt at{*ambient.surface(), place, now.rotation(), now.centre()};
  joinVessel(at.sloshing(), twistInWater(ambient, now.state), states.data());
  return energyOfSloshing(at.sloshing(), states.data()).kinetic;
}

Vector6 sloshForRows(AmbientBody& ambient, const RigidState& now, double duration,
                     const Vector6& x) noexcept {
  VesselState& vessel = *ambient.vessel;
  VesselSloshing& sloshing = vessel.sloshing;
  const WaterAt at = waterAt(ambient, now.orientation.toRotationMatrix(), now.position);
  sloshing.moved = sloshing.now;
  joinVessel(at.sloshing(), x, sloshing.moved.data());
  const Sloshed end =
      exchangeSloshing(at.sloshing(), ambient.flotation().inverse,
                       ambient.def->holds.sloshing_damping, duration, x, sloshing.moved.data());
  vessel.before_rows = WaterLeft(at, sloshing.moved.data(),
                                 energyOfSloshing(at.sloshing(), sloshing.moved.data()).sum());
  return end.twist;
}

Vector6 arriveWithWater(AmbientBody& ambient, const Matrix3& to_world, const Vector3& position_W,
                        bool keeps_momentum, const Vector6& x, SymmetricMatrix& inertia) noexcept {
  VesselState& vessel = *ambient.vessel;
  Sloshing* const states = vessel.sloshing.moved.data();
  const WaterAt at = waterAt(ambient, to_world, position_W);
  Vector6 end = x;
  if (keeps_momentum)
    end = shiftWater(vessel.before_rows, at, x, inertia, states);
  else
    projectOnModes(at.sloshing(), vessel.before_rows.energy, states);
  std::swap(vessel.sloshing.now, vessel.sloshing.moved);
  vessel.sloshing_energy = energyOfSloshing(at.sloshing(), vessel.sloshing.now.data()).sum();
  return end;
}

}  // namespace ambient
