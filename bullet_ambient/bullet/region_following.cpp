#include "bullet_ambient/bullet/region_following.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

bool isSameFluid(const MediumLoads& loads, const Medium& medium) {
  return loads.density == medium.density && loads.viscosity == medium.viscosity;
}

const MediumLoads* findLoads(const std::vector<MediumLoads>& loads, const Medium& medium) {
  const auto found = std::find_if(loads.begin(), loads.end(), [&](const MediumLoads& entry) {
    return isSameFluid(entry, medium);
  });
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

SurfaceMedia makeSurfaceMediaOf(const AttachDef& def, const FluidRegion& region,
                                LoadTables& tables) {
  SurfaceModelDef model;
  model.shape = def.fluid_body;
  model.fluid_frame = def.fluid_frame;
  model.mass = {1, Matrix3::Identity()};
  model.above = region.above;
  model.below = region.below;
  // Whether it blows decides on loads; a function may blow.
  if (region.flow && model.above.velocity.isZero(0)) model.above.velocity = Vector3::Ones();
  model.flow = def.flow;
  model.wave_damping = def.wave_damping;
  SurfaceMedia made{region.below, region.above, makeSurfaceModel(model, tables),
                    nullptr,      {},           false};
  const auto& loads = made.model.loads_below.loads;
  if (loads) made.loads = std::make_shared<LoadsAtSurface>(loads);
  return made;
}

}  // namespace

std::vector<MediumLoads> makeMediumLoads(const AttachDef& def, const FluidRegions& regions,
                                         LoadTables& tables,
                                         const std::vector<MediumLoads>& known) {
  std::vector<MediumLoads> made;
  const auto add = [&](const Medium& medium) {
    if (findLoads(made, medium)) return;
    const MediumLoads* old = findLoads(known, medium);
    made.push_back({medium.density, medium.viscosity,
                    old ? old->loads : makeSurfaceLoads(def.fluid_body, medium, def.flow, tables)});
  };
  add(def.medium);
  if (!def.follow_regions) return made;
  for (const FluidRegions::Entry& entry : regions.all()) {
    add(entry.region.below);
    if (entry.region.surface) add(entry.region.above);
  }
  return made;
}

std::vector<SurfaceMedia> makeSurfaceMedia(const AttachDef& def, const FluidRegions& regions,
                                           LoadTables& tables,
                                           const std::vector<SurfaceMedia>& known) {
  std::vector<SurfaceMedia> made;
  if (!def.follow_regions) return made;
  for (const FluidRegions::Entry& entry : regions.all()) {
    const FluidRegion& region = entry.region;
    if (!region.surface || findSurface(made, region.below, region.above) >= 0) continue;
    const int old = findSurface(known, region.below, region.above);
    made.push_back(old >= 0 ? known[static_cast<std::size_t>(old)]
                            : makeSurfaceMediaOf(def, region, tables));
  }
  return made;
}

void replaceSurfaces(AmbientBody& ambient, std::vector<SurfaceMedia> surfaces) {
  int known = 0;
  for (const SurfaceMedia& old : ambient.surfaces)
    if (findSurface(surfaces, old.below, old.above) >= 0) ++known;
  if (known < static_cast<int>(surfaces.size())) markStale(ambient);  // new ones lack the mass
  if (const SurfaceMedia* at = ambient.surface()) {
    ambient.encounter.media = findSurface(surfaces, at->below, at->above);
    if (!ambient.surface() && ambient.is_frozen) markStale(ambient);
  }
  ambient.surfaces = std::move(surfaces);
}

bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept {
  const Medium& before = ambient.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    const MediumLoads* found = findLoads(ambient.media, medium);
    if (!found) return false;
    ambient.model.loads = found->loads;
    ++ambient.counters.medium_changes;
    markStale(ambient);
  }
  if (!(place == ambient.place)) ambient.memory = {};
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
  const Vector3 centre = toVector3(ambient.body->getWorldTransform().getOrigin());
  const FluidRegions::Entry* entry = regions.find(centre, ambient.counters.regions_asked);
  ambient.may_rest = !entry || isSteady(entry->region);
  const long long changes = ambient.counters.medium_changes;
  if (!entry) {
    enterMedium(ambient, {}, ambient.def.medium);
    return ambient.counters.medium_changes != changes;
  }
  const RegionSample sample = sampleRegion(entry->region, centre, regions.time);
  if (!sample.is_finite) {
    ++ambient.counters.rejected;
    sayNotFinite(entry->id, complaints);
  }
  const SurfaceSide side =
      entry->region.surface ? meetSurface(ambient, sample, duration) : SurfaceSide::kBelow;
  const bool is_above = side == SurfaceSide::kAbove;
  [[maybe_unused]] const bool has_loads =
      enterMedium(ambient, {entry->id, is_above, side == SurfaceSide::kAt},
                  is_above ? sample.above : sample.below);
  AMBIENT_ASSERT(has_loads);
  return ambient.counters.medium_changes != changes;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
