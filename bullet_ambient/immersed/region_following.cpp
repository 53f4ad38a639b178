#include "bullet_ambient/immersed/region_following.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/flow_along.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/immersed/vessel_step.h"

namespace ambient {
namespace {

// Allocates nothing.
void warnOfNotFinite(RegionId id, Warnings& warnings) noexcept {
  char sentence[200];
  std::snprintf(sentence, sizeof sentence,
                "bullet_ambient: the flow or the surface of the region of fluid %d is not finite "
                "where a body is; the region's fluid is taken without both there",
                static_cast<int>(id));
  warnings.warnOnce(Warning::kRegion, sentence);
}

// Says it if the surface's direction up is more than 45 degrees off the upward vertical. Allocates
// nothing.
void checkUp(RegionId id, const Vector3& up, const Vector3& gravity, Warnings& warnings) noexcept {
  constexpr double kCosine = 0.7071067811865475;
  if (!(up.dot(gravity) > -kCosine * gravity.norm()) || up.isZero(0) || gravity.isZero(0)) return;
  char sentence[300];
  std::snprintf(
      sentence, sizeof sentence,
      "bullet_ambient: the surface of the region of fluid %d has (%.3g, %.3g, %.3g) as its "
      "direction up, but gravity is (%.3g, %.3g, %.3g) m/s^2; up must be against gravity",
      static_cast<int>(id), up.x(), up.y(), up.z(), gravity.x(), gravity.y(), gravity.z());
  warnings.warnOnce(Warning::kUp, sentence);
}

RegionSample sampleFor(AmbientBody& ambient, const MotionView& now,
                       const FluidRegions::Entry& entry, const FluidRegions& regions,
                       Warnings& warnings) noexcept {
  RegionCall call(regions);
  const RegionSample sample =
      sampleRegion(entry.region, pointIn(entry.region, now.centre()), regions.time,
                   ambient.def->medium, halfHeight(ambient, now, entry.region));
  if (sample.is_finite) return sample;
  ++ambient.counters.rejected;
  if (!call.was_refused) warnOfNotFinite(entry.id, warnings);  // or it was said what it did
  return sample;
}

// A step of one body in a fluid.
struct FlowStep {
  const FluidRegions& regions;
  const FluidRegions::Entry* entry = nullptr;  // region of the fluid; null: the body's own medium
  double duration = 0;                         // [s]
  const MotionView* now = nullptr;             // at its start; null: the body is in no region
};

// Largest acceleration of the water around a body at its surface, in gravities: the surface stands
// normal to gravity as the water feels it, so that it tilts by 14 degrees at most.
constexpr double kLargestAtSurface = 0.25;

RegionId idOf(const FlowStep& step) { return step.entry ? step.entry->id : RegionId::kNone; }

const BareVelocity& bareOf(const RegionSample& sample, bool is_above) {
  return is_above ? sample.bare_above : sample.bare_below;
}

// Returns the bare velocity of the fluid now at the place where the body was in its last substep.
BareVelocity bareThere(const AmbientBody& ambient, const FlowStep& step, const BareVelocity& here) {
  if (!step.entry || isSteady(step.entry->region)) return here;
  RegionCall call(step.regions);
  return bareOf(sampleRegion(step.entry->region, ambient.flow.position, step.regions.time,
                             ambient.def->medium),
                ambient.flow.is_above);
}

// Returns how much the velocity has changed, at that place, since the body saw it.
Vector3 changeSince(const AmbientBody& ambient, const FlowStep& step, const BareVelocity& here) {
  const FlowMemory& seen = ambient.flow;
  const bool has_seen = seen.until == step.regions.time && seen.region == idOf(step);
  if (!has_seen || seen.parts != here.parts || seen.velocity == here.velocity)
    return Vector3::Zero();
  const BareVelocity there = bareThere(ambient, step, here);
  if (there.parts != seen.parts) return Vector3::Zero();
  return there.velocity - seen.velocity;
}

// Returns the part of a change that comes about in this step.
Vector3 partInStep(const AmbientBody& ambient, const Vector3& change, const FlowStep& step) {
  if (!step.now || !ambient.location.is_at_surface || change.isZero(0)) return change;
  const double gravity = step.now->gravity.norm();
  return std::min(1.0, kLargestAtSurface * gravity * step.duration / change.norm()) * change;
}

// Makes the fluid of a sample go on from what the body has seen in its last substep: gives the
// medium in which the body was its velocity of then, and the acceleration by which this becomes,
// in the step, what the sample has; docs/theory.md eq. (19a). Changes nothing if the body was in
// another region, or did not take part in the last substep. Remembers what the body sees. Calls
// the region's functions once more, where the body was, if what they give differs from that.
// Allocates nothing.
void followFlow(AmbientBody& ambient, const FlowStep& step, RegionSample& sample) {
  ambient.flow.change.setZero();
  if (!(step.duration > 0)) return;  // the body is being attached or changed, and sees nothing
  const bool is_above = ambient.flow.is_above;
  const BareVelocity& bare = bareOf(sample, is_above);
  const Vector3 change = changeSince(ambient, step, bare);
  const Vector3 in_step = partInStep(ambient, change, step);
  Medium& medium = is_above ? sample.above : sample.below;
  medium.velocity -= change;
  medium.acceleration += in_step / step.duration;
  const Vector3 position =
      step.entry ? pointIn(step.entry->region, step.now->centre()) : Vector3(Vector3::Zero());
  ambient.flow = {step.regions.time + step.duration,
                  position,
                  bare.velocity - (change - in_step),
                  change,
                  bare.parts,
                  idOf(step),
                  is_above};
}

// Tells on which side of its region's surface the body really is, and the velocity there.
void changeSide(FlowMemory& memory, bool is_above, const BareVelocity& bare) noexcept {
  if (is_above == memory.is_above) return;
  memory.is_above = is_above;
  memory.change.setZero();
  memory.velocity = bare.velocity;
  memory.parts = bare.parts;
}

// Returns the fluid around a body in no region.
RegionSample ownSample(const AmbientBody& ambient) {
  RegionSample sample;
  sample.below = ambient.def->medium;
  sample.bare_below = bareVelocityOf(sample.below);
  return sample;
}

// Samples the stations of a body of which the fluid may differ along it; none: it does not.
std::optional<StationSamples> sampleStations(AmbientBody& ambient, const MotionView& now,
                                             const FluidRegions& regions,
                                             const RegionsAround& around,
                                             const RegionSample& centre,
                                             Warnings& warnings) noexcept {
  if (!needsStations(ambient, around)) return std::nullopt;
  std::optional<StationSamples> stations(std::in_place, ambient, now, regions, around, centre);
  ambient.may_rest = ambient.may_rest && stations->isSteady();
  if (stations->isFinite()) return stations;
  ++ambient.counters.rejected;
  if (around.entry) warnOfNotFinite(around.entry->id, warnings);
  return stations;
}

// Puts a body into its own medium beside regions.
void enterOwnMedium(AmbientBody& ambient, const FlowStep& step, const RegionsAround& around,
                    Warnings& warnings) noexcept {
  RegionSample sample = ownSample(ambient);
  const auto stations = sampleStations(ambient, *step.now, step.regions, around, sample, warnings);
  followFlow(ambient, step, sample);
  if (stations) {
    stations->addMeans(&RegionSample::below, sample);
    *ambient.flow_along = stations->flowAlong(&RegionSample::below);
  }
  enterMedium(ambient, {}, sample.below);
}

// Returns the side of a region's surface on which a body is. `is_alone`: no bounds cross the body.
// Sides of a pool are held on the body over the step: they are those of its middle.
SurfaceSide findWaterSide(AmbientBody& ambient, const FlowStep& step, bool is_alone,
                          const RegionSample& sample) noexcept {
  const FluidRegion& region = step.entry->region;
  const NearSurface near = nearSurface(ambient, *step.now, SurfaceKind(region), sample,
                                       pointIn(region, step.now->centre()), step.duration);
  if (ambient.vessel) meetSurface(ambient, near, region);
  const bool has_sides = !is_alone && near.side != SurfaceSide::kAbove;
  return enterSurface(
      ambient, near, sample,
      has_sides ? findSides(ambient, *step.now, step.regions, *step.entry, step.duration / 2)
                : PoolSides{});
}

// Finds on which side of the surface of its region a body is, and what of the flow differs along
// it. `is_alone`: no bounds cross the body.
SurfaceSide findSide(AmbientBody& ambient, const FlowStep& step, bool is_alone,
                     const std::optional<StationSamples>& stations, RegionSample& sample) noexcept {
  const Vector3& gravity = step.now->gravity;
  if (stations) {
    stations->addMeans(&RegionSample::below, sample);
    stations->fitSurface(gravity, sample);
  }
  const SurfaceSide side = step.entry->region.surface
                               ? findWaterSide(ambient, step, is_alone, sample)
                               : SurfaceSide::kBelow;
  if (!stations) return side;
  const bool is_above = side == SurfaceSide::kAbove;
  if (is_above) stations->addMeans(&RegionSample::above, sample);
  const PoolSides sides_F = ambient.flow_along->sides_F;
  *ambient.flow_along = stations->flowAlong(is_above ? &RegionSample::above : &RegionSample::below);
  ambient.flow_along->sides_F = sides_F;
  if (side == SurfaceSide::kAt && !sample.tilt.isZero(0))
    ambient.flow_along->lean_W = leanOf(sample, gravity);
  return side;
}

}  // namespace

bool enterMedium(AmbientBody& ambient, const RegionLocation& location,
                 const Medium& medium) noexcept {
  const Medium& before = ambient.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    const MediumModel* found = ambient.models->find(FluidKind(medium));
    if (!found) return false;
    ambient.in_medium = {ambient.models, found};
    forgetFlight(ambient);
    ++ambient.counters.medium_changes;
  }
  if (!(location == ambient.location)) {
    forgetFlight(ambient);
    forgetWake(ambient);
    if (!location.is_at_surface) forgetSurface(ambient);
  }
  if (!location.is_at_surface) ambient.surface_media = -1;
  ambient.location = location;
  ambient.medium = medium;
  return true;
}

namespace {

// True if a body in no region goes on in its own medium, which has been the same since its last
// substep and does not change.
bool goesOnInOwnMedium(const AmbientBody& ambient, const FluidRegions& regions) noexcept {
  const Medium &own = ambient.def->medium, &now = ambient.medium;
  const FlowMemory& seen = ambient.flow;
  return seen.until == regions.time && seen.region == RegionId::kNone && !seen.is_above &&
         ambient.location == RegionLocation{} && own.acceleration.isZero(0) &&
         now.acceleration.isZero(0) && seen.velocity == own.velocity &&
         now.velocity == own.velocity && now.density == own.density &&
         now.viscosity == own.viscosity;
}

}  // namespace

void stayInOwnMedium(AmbientBody& ambient, const FluidRegions& regions, double duration) noexcept {
  if (hasFlowAlong(ambient)) *ambient.flow_along = {};
  ambient.may_rest = true;
  if (duration > 0 && goesOnInOwnMedium(ambient, regions)) {
    ambient.flow.until = regions.time + duration;
    return;
  }
  RegionSample sample = ownSample(ambient);
  followFlow(ambient, {regions, nullptr, duration}, sample);
  enterMedium(ambient, {}, sample.below);
}

void followRegions(AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                   double duration, Warnings& warnings) noexcept {
  const RegionsAround around =
      findRegions(ambient, now, regions, duration, ambient.counters.regions_asked);
  const FluidRegions::Entry* entry = around.entry;
  if (hasFlowAlong(ambient)) *ambient.flow_along = {};
  ambient.may_rest = !entry || isSteady(entry->region);
  const FlowStep step{regions, entry, duration, &now};
  if (!entry) return enterOwnMedium(ambient, step, around, warnings);
  RegionSample sample = sampleFor(ambient, now, *entry, regions, warnings);
  const HoldAround* const hold = holdAround(ambient, regions, *entry);
  const auto stations =
      hold ? std::nullopt : sampleStations(ambient, now, regions, around, sample, warnings);
  if (hold) {
    replaceSurfaceByHold(*hold, ambient, now, sample);
    ambient.flow = {};
    ambient.may_rest = ambient.may_rest && (hold->is_dry || !hold->is_awake);
  } else {
    followFlow(ambient, step, sample);
  }
  if (entry->region.surface) checkUp(entry->id, entry->region.surface->up(), now.gravity, warnings);
  const SurfaceSide side = findSide(ambient, step, hold || around.is_alone, stations, sample);
  const bool is_above = side == SurfaceSide::kAbove;
  changeSide(ambient.flow, is_above, is_above ? sample.bare_above : sample.bare_below);
  [[maybe_unused]] const bool is_known =
      enterMedium(ambient, {entry->id, is_above, side == SurfaceSide::kAt},
                  is_above ? sample.above : sample.below);
  AMBIENT_ASSERT(is_known);
}

void refreshModels(AmbientBody& ambient, const InverseMass& mass, const FluidRegions& regions,
                   ModelTables& tables) {
  auto models =
      makeFluidModels(*ambient.def, mass.mass > 0 ? mass : InverseMass{}, regions.fluids(), tables);
  ambient.medium = ambient.def->medium;
  ambient.load_scale = ambient.def->load_factor;
  ambient.location = {};
  ambient.surface_media = -1;
  forgetSurface(ambient);
  forgetFlight(ambient);
  setModels(ambient, std::move(models));
  setHolds(ambient);
  ambient.in_medium = {ambient.models, &ambient.models->media.front()};
  makeStations(ambient, regions);
}

void makeStations(AmbientBody& ambient, const FluidRegions& regions) {
  const std::shared_ptr<const FluidBody>& shape = ambient.def->fluid_body;
  const bool has_stations = ambient.models->stations.reach > 0 && regions.mayDiffer();
  const bool has_layers = shape->volume > 0 && regions.haveLayers();
  if ((has_stations || has_layers) && !ambient.flow_along)
    ambient.flow_along = std::make_unique<FlowAlongBody>();
  ambient.hull =
      has_layers && !(shape->sphere_radius > 0) ? LoadTables(shape).hull().get() : nullptr;
}

}  // namespace ambient
