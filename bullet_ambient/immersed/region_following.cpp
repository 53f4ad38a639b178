#include "bullet_ambient/immersed/region_following.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/immersed/region_call.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
namespace {

const MediumLoads* findLoads(const std::vector<MediumLoads>& loads, const FluidKind& kind) {
  const auto found = std::find_if(loads.begin(), loads.end(),
                                  [&](const MediumLoads& entry) { return entry.kind == kind; });
  return found == loads.end() ? nullptr : &*found;
}

// Allocates nothing.
void sayNotFinite(RegionId id, Complaints& complaints) noexcept {
  char sentence[200];
  std::snprintf(sentence, sizeof sentence,
                "bullet_ambient: the flow or the surface of the region of fluid %d is not finite "
                "where a body is; the region's fluid is taken without both there",
                static_cast<int>(id));
  complaints.say(Complaint::kRegion, sentence);
}

// Says it if the surface's direction up is more than 45 degrees off the upward vertical. Allocates
// nothing.
void checkUp(RegionId id, const Vector3& up, const Vector3& gravity,
             Complaints& complaints) noexcept {
  constexpr double kCosine = 0.7071067811865475;
  if (!(up.dot(gravity) > -kCosine * gravity.norm()) || up.isZero(0) || gravity.isZero(0)) return;
  char sentence[300];
  std::snprintf(
      sentence, sizeof sentence,
      "bullet_ambient: the surface of the region of fluid %d has (%.3g, %.3g, %.3g) as its "
      "direction up, but gravity is (%.3g, %.3g, %.3g) m/s^2; up must be against gravity",
      static_cast<int>(id), up.x(), up.y(), up.z(), gravity.x(), gravity.y(), gravity.z());
  complaints.say(Complaint::kUp, sentence);
}

Vector3 centreOf(const AmbientBody& ambient) {
  return toVector3(ambient.body->getWorldTransform().getOrigin());
}

RegionSample sampleFor(AmbientBody& ambient, const FluidRegions::Entry& entry,
                       const FluidRegions& regions, Complaints& complaints) noexcept {
  RegionCall call(regions);
  const RegionSample sample =
      sampleRegion(entry.region, centreOf(ambient), regions.time, ambient.def.medium);
  if (sample.is_finite) return sample;
  ++ambient.counters.rejected;
  if (!call.was_refused) sayNotFinite(entry.id, complaints);  // or it was said what it did
  return sample;
}

SurfaceMedia makeSurfaceMedia(const AttachDef& def, const SurfaceKind& kind, LoadTables& tables) {
  SurfaceModelDef model;
  model.shape = def.fluid_body;
  model.fluid_frame = def.fluid_frame;
  model.mass = {1, Matrix3::Identity()};
  model.above = kind.mediumAbove(def.medium);
  model.below = kind.below.medium();
  // Whether it blows decides on loads.
  if (kind.may_blow) model.above.velocity = Vector3::Ones();
  model.flow = def.flow;
  model.wave_damping = def.wave_damping;
  SurfaceMedia made{kind, makeSurfaceModel(model, tables), nullptr, {}, false};
  const auto& loads = made.model.loads_below.loads;
  if (loads) made.loads = std::make_shared<LoadsAtSurface>(loads);
  return made;
}

template <class Kind>
bool isAmong(const std::vector<Kind>& kinds, const Kind& kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

MediumLoads makeOwnLoads(const AttachDef& def, LoadTables& tables) {
  return {FluidKind(def.medium), makeSurfaceLoads(def.fluid_body, def.medium, def.flow, tables)};
}

KnownFluids makeKnownFluids(const AttachDef& def, const RegionFluids& fluids, LoadTables& tables) {
  KnownFluids known;
  if (!def.follow_regions) return known;
  for (const FluidKind& kind : fluids.media)
    if (!(kind == FluidKind(def.medium)))
      known.media.push_back(
          {kind, makeSurfaceLoads(def.fluid_body, kind.medium(), def.flow, tables)});
  for (const SurfaceKind& kind : fluids.surfaces)
    known.surfaces.push_back(makeSurfaceMedia(def, kind, tables));
  return known;
}

void learnFluids(AmbientBody& ambient, KnownFluids fluids) {
  if (!fluids.surfaces.empty()) markStale(ambient);  // the new ones lack the mass
  std::move(fluids.media.begin(), fluids.media.end(), std::back_inserter(ambient.media));
  std::move(fluids.surfaces.begin(), fluids.surfaces.end(), std::back_inserter(ambient.surfaces));
}

void forgetFluids(AmbientBody& ambient, const RegionFluids& fluids) {
  std::vector<MediumLoads>& media = ambient.media;
  media.erase(
      std::remove_if(media.begin() + 1, media.end(),  // without its own
                     [&](const MediumLoads& loads) { return isAmong(fluids.media, loads.kind); }),
      media.end());
  std::optional<SurfaceKind> met;
  if (const SurfaceMedia* surface = ambient.surface()) met = surface->kind;
  std::vector<SurfaceMedia>& surfaces = ambient.surfaces;
  surfaces.erase(std::remove_if(surfaces.begin(), surfaces.end(),
                                [&](const SurfaceMedia& surface) {
                                  return isAmong(fluids.surfaces, surface.kind);
                                }),
                 surfaces.end());
  if (!met) return;
  ambient.encounter.media = findSurface(surfaces, *met);
  if (!ambient.surface() && ambient.is_frozen) markStale(ambient);
}

bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept {
  const Medium& before = ambient.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    const MediumLoads* found = findLoads(ambient.media, FluidKind(medium));
    if (!found) return false;
    ambient.model.loads = found->loads;
    ++ambient.counters.medium_changes;
    markStale(ambient);
  }
  if (!(place == ambient.place)) {
    ambient.memory = {};
    ambient.wake = {};
  }
  if (!place.is_at_surface) {
    if (ambient.is_frozen) markStale(ambient);
    ambient.encounter.media = -1;
    ambient.encounter.waves = {};
    ambient.encounter.met_B.reset();
  }
  ambient.place = place;
  ambient.medium = medium;
  return true;
}

bool followRegions(AmbientBody& ambient, const FluidRegions& regions, double duration,
                   Complaints& complaints) noexcept {
  if (!ambient.def.follow_regions) return false;
  if (regions.empty() && ambient.place.region == RegionId::kNone) return false;
  const FluidRegions::Entry* entry =
      regions.find(centreOf(ambient), ambient.counters.regions_asked);
  ambient.may_rest = !entry || isSteady(entry->region);
  const long long changes = ambient.counters.medium_changes;
  if (!entry) {
    enterMedium(ambient, {}, ambient.def.medium);
    return ambient.counters.medium_changes != changes;
  }
  const RegionSample sample = sampleFor(ambient, *entry, regions, complaints);
  if (entry->region.surface)
    checkUp(entry->id, entry->region.surface->up(), toVector3(ambient.body->getGravity()),
            complaints);
  const SurfaceSide side = entry->region.surface
                               ? meetSurface(ambient, SurfaceKind(entry->region), sample, duration)
                               : SurfaceSide::kBelow;
  const bool is_above = side == SurfaceSide::kAbove;
  [[maybe_unused]] const bool has_loads =
      enterMedium(ambient, {entry->id, is_above, side == SurfaceSide::kAt},
                  is_above ? sample.above : sample.below);
  AMBIENT_ASSERT(has_loads);
  return ambient.counters.medium_changes != changes;
}

void refreshModel(AmbientBody& ambient, const FluidRegions& regions, LoadTables& tables) {
  AmbientBody fresh = ambient;
  fresh.media = {makeOwnLoads(ambient.def, tables)};
  fresh.surfaces.clear();
  learnFluids(fresh, makeKnownFluids(ambient.def, regions.fluids(), tables));
  fresh.medium = ambient.def.medium;
  fresh.place = {};
  fresh.encounter = {};
  const auto& loads = fresh.media.front().loads;
  if (ambient.body->getInvMass() > 0) {
    buildModel(fresh, loads);
  } else {
    buildUnitModel(fresh, loads);
  }
  ambient = std::move(fresh);
}

AMBIENT_END
