#include "bullet_ambient/immersed/vessel_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bullet_ambient/immersed/flow_along.h"

namespace ambient {
namespace {

/// A body in a region with waves.
struct AtWaves {
  const AmbientBody& ambient;
  const FluidRegions& regions;
  const FluidRegion& region;
  Matrix3 R_WF;
  Vector3 origin_W, up;
};

/// Whether an opening is so near to the plane that waves may reach it: their slope is below 1.
bool isNear(const AtWaves& at, const SurfacePlane& plane_F, const OpeningShape& opening) {
  const double reach = at.ambient.surface()->radius;
  const auto& edges = opening.edges();
  return std::any_of(edges.begin(), edges.end(), [&](const OpeningShape::Edge& edge) {
    return std::abs(plane_F.depth(edge.middle)) < reach;
  });
}

/// Height of the surface over or under a place above the plane, along its normal [m]; 0 where the
/// surface is not finite.
double riseAt(const AtWaves& at, const Vector3& place_F) {
  const SurfacePlane& plane_W = at.ambient.floating->plane_W;
  const Vector3 place_W = at.origin_W + at.R_WF * place_F;
  RegionCall call(at.regions);
  const RegionSample sample =
      sampleRegion(at.region, place_W, at.regions.time, at.ambient.def->medium);
  if (!sample.is_finite) return 0;
  return plane_W.normal.dot(place_W + sample.height * at.up) - plane_W.height;
}

}  // namespace

void findRimWaves(AmbientBody& ambient, const MotionView& now,
                  const FluidRegions& regions) noexcept {
  VesselState& vessel = *ambient.vessel;
  vessel.has_waves = false;
  const auto found = regions.all().find(ambient.place.region);
  if (found == regions.all().end()) return;
  const FluidRegion& region = found->second.region;
  const SurfaceModel& model = *ambient.surface();
  if (!isLargeAgainstWaves(region, 2 * model.radius)) return;
  const FrameOffset& frame = model.fluid_frame;
  const Matrix3 R = now.rotation();
  const AtWaves at{ambient,
                   regions,
                   region,
                   R * frame.rotation,
                   now.centre() + R * frame.translation,
                   -now.gravity.normalized()};
  const SurfacePlane plane_F = seenFrom(ambient.floating->plane_W, at.R_WF, at.origin_W);
  vessel.has_waves = true;
  forEachOpening(*model.holds, &vessel.changes,
                 [&](const HoldShapes::Opening& opening, std::size_t number) {
                   std::vector<double>& rises = vessel.rises[number];
                   std::fill(rises.begin(), rises.end(), 0.0);
                   if (opening.to >= 0 || !isNear(at, plane_F, opening.shape)) return;
                   for (std::size_t i = 0; i < rises.size(); ++i)
                     rises[i] = riseAt(at, opening.shape.edges()[i].middle);
                 });
}

const HoldAround* holdAround(const AmbientBody& ambient, const FluidRegions& regions,
                             const FluidRegions::Entry& entry) noexcept {
  if (ambient.in_hold < 0 || !entry.region.surface) return nullptr;
  const HoldAround& around = regions.in_holds[static_cast<std::size_t>(ambient.in_hold)];
  return around.region == entry.id ? &around : nullptr;
}

void takeHold(const HoldAround& around, const AmbientBody& ambient, const MotionView& now,
              RegionSample& sample) noexcept {
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

void saySunk(AmbientBody& ambient, Complaints& complaints) noexcept {
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
  if (vessel.has_sunk) complaints.saySunk(*ambient.def, filled);
}

}  // namespace ambient
