#include "bullet_ambient/bullet/region_following.h"

#include <algorithm>

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

bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept {
  const Medium& before = ambient.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    const MediumLoads* found = findLoads(ambient.media, medium);
    if (!found) return false;
    ambient.model.loads = found->loads;
    ++ambient.counters.medium_changes;
    markStale(ambient);
  }
  if (!(place == ambient.place)) ambient.memory.has_load = false;
  ambient.place = place;
  ambient.medium = medium;
  return true;
}

bool followRegions(AmbientBody& ambient, const FluidRegions& regions,
                   Complaints& complaints) noexcept {
  if (!ambient.def.follow_regions) return false;
  if (regions.empty() && ambient.place.region == RegionId::kNone) return false;
  const Vector3 centre = toVector3(ambient.body->getWorldTransform().getOrigin());
  const FluidRegions::Entry* entry = regions.find(centre, ambient.counters.regions_asked);
  RegionPlace place;
  Medium medium = ambient.def.medium;
  if (entry) {
    const RegionMedium here = mediumAt(entry->region, centre, regions.time);
    place = {entry->id, here.is_above};
    medium = here.medium;
    if (!here.is_finite) {
      ++ambient.counters.rejected;
      complaints.say(Complaint::kRegion);
    }
  }
  ambient.may_rest = !entry || isSteady(entry->region);
  const long long changes = ambient.counters.medium_changes;
  const bool has_loads = enterMedium(ambient, place, medium);
  AMBIENT_ASSERT(has_loads);
  return ambient.counters.medium_changes != changes;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
