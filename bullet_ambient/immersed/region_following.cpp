#include "bullet_ambient/immersed/region_following.h"

#include <cstdio>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/immersed/region_call.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
namespace {

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
      sampleRegion(entry.region, centreOf(ambient), regions.time, ambient.def->medium);
  if (sample.is_finite) return sample;
  ++ambient.counters.rejected;
  if (!call.was_refused) sayNotFinite(entry.id, complaints);  // or it was said what it did
  return sample;
}

}  // namespace

bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept {
  const Medium& before = ambient.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    const MediumModel* found = ambient.models->find(FluidKind(medium));
    if (!found) return false;
    ambient.in_medium = {ambient.models, found};
    forgetFlight(ambient);
    ++ambient.counters.medium_changes;
  }
  if (!(place == ambient.place)) {
    forgetFlight(ambient);
    forgetWake(ambient);
    if (!place.is_at_surface) forgetSurface(ambient);
  }
  if (!place.is_at_surface) ambient.surface_media = -1;
  ambient.place = place;
  ambient.medium = medium;
  return true;
}

void followRegions(AmbientBody& ambient, const FluidRegions& regions, double duration,
                   Complaints& complaints) noexcept {
  if (!ambient.def->follow_regions) return;
  if (regions.empty() && ambient.place.region == RegionId::kNone) return;
  const FluidRegions::Entry* entry =
      regions.find(centreOf(ambient), ambient.counters.regions_asked);
  ambient.may_rest = !entry || isSteady(entry->region);
  if (!entry) {
    enterMedium(ambient, {}, ambient.def->medium);
    return;
  }
  const RegionSample sample = sampleFor(ambient, *entry, regions, complaints);
  if (entry->region.surface)
    checkUp(entry->id, entry->region.surface->up(), toVector3(ambient.body->getGravity()),
            complaints);
  const SurfaceSide side = entry->region.surface
                               ? meetSurface(ambient, SurfaceKind(entry->region), sample, duration)
                               : SurfaceSide::kBelow;
  const bool is_above = side == SurfaceSide::kAbove;
  [[maybe_unused]] const bool is_known =
      enterMedium(ambient, {entry->id, is_above, side == SurfaceSide::kAt},
                  is_above ? sample.above : sample.below);
  AMBIENT_ASSERT(is_known);
}

void refreshModels(AmbientBody& ambient, const FluidRegions& regions, ModelTables& tables) {
  const btRigidBody& body = *ambient.body;
  const InverseMass mass = body.getInvMass() > 0 ? inverseMassOf(body) : InverseMass{};
  auto models = makeFluidModels(*ambient.def, mass, regions.fluids(), tables);
  ambient.medium = ambient.def->medium;
  ambient.place = {};
  ambient.surface_media = -1;
  forgetSurface(ambient);
  forgetFlight(ambient);
  setModels(ambient, std::move(models));
  ambient.in_medium = {ambient.models, &ambient.models->media.front()};
}

AMBIENT_END
