#include "bullet_ambient/immersed/wet_state.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

#include "bullet_ambient/force/surface/wet_polygon.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/flow_along.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/immersed/vessel_step.h"

namespace ambient {
namespace {

/// Share of a triangle's area, by the depths of its corners.
double wetShareOfTriangle(std::array<double, 3> depths) {
  std::sort(depths.begin(), depths.end(), std::greater<>());
  const auto [deep, middle, high] = depths;
  if (high >= 0) return 1;
  if (deep <= 0) return 0;
  if (middle <= 0) return deep * deep / ((deep - middle) * (deep - high));
  return 1 - high * high / ((deep - high) * (middle - high));
}

/// Part of a body's surface that is in the water.
struct WetSurface {
  double share = 0;    ///< of the area [1]
  double draught = 0;  ///< depth of its lowest point [m]
};

/// Adds a triangle with its part below a plane in F and between the sides of its pool. `share` is
/// an area here [m^2].
void addWetTriangle(const Vector3 (&corners)[3], const SurfacePlane& plane, WetSurface& wet) {
  if (plane.sides_F) {
    const WetPolygon part(PoolFrame(plane), corners);
    part.forEachTriangle([&wet](const Vector3& a, const Vector3& b, const Vector3& c) {
      wet.share += (b - a).cross(c - a).norm() / 2;
    });
    for (int i = 0; i < part.count(); ++i) wet.draught = std::max(wet.draught, part.corner(i).z());
    return;
  }
  wet.share += (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2 *
               wetShareOfTriangle(
                   {plane.depth(corners[0]), plane.depth(corners[1]), plane.depth(corners[2])});
}

WetSurface wetSurfaceOf(const FluidBody& shape, const Immersion& immersion) {
  const SurfacePlane& plane = immersion.plane;
  const double radius = shape.sphere_radius;
  if (radius > 0)
    return {std::clamp(0.5 + plane.depth(shape.centre_of_volume) / (2 * radius), 0.0, 1.0),
            immersion.draught()};
  const std::vector<std::int32_t>& triangles = shape.surface.triangles;
  WetSurface wet;
  double all = 0;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vector3 corners[3] = {vertexOf(shape.surface, triangles[i]),
                                vertexOf(shape.surface, triangles[i + 1]),
                                vertexOf(shape.surface, triangles[i + 2])};
    all += (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
    addWetTriangle(corners, plane, wet);
  }
  wet.share = all > 0 ? wet.share / all : 0;
  if (!plane.sides_F) wet.draught = immersion.draught();
  return wet;
}

WetState wholly(const AmbientBody& ambient, const RigidState& pose, bool is_wet) {
  const FluidBody& shape = *ambient.def->fluid_body;
  WetState state;
  state.centre_of_buoyancy = pose.position + pose.orientation * ambient.model().centre_of_volume;
  if (!is_wet) return state;
  state.share = 1;
  state.volume = shape.volume;
  state.area = shape.area;
  state.draught = std::numeric_limits<double>::infinity();
  return state;
}

WetState cutBy(const SurfacePlane& plane_B, const SurfaceModel& model, const AmbientBody& ambient,
               const RigidState& pose) {
  const FluidBody& shape = *model.shape;
  const Immersion immersion = immersionOf(model, plane_B);
  if (immersion.isDry() || (plane_B.sides_F && !(immersion.wet.volume > 0)))
    return wholly(ambient, pose, false);
  WetState state;
  state.volume = immersion.wet.volume;
  state.share = wetShare(immersion, shape.volume);
  const WetSurface surface = wetSurfaceOf(shape, immersion);
  state.draught = surface.draught;
  state.area = shape.area * surface.share;
  state.centre_of_buoyancy = wholly(ambient, pose, false).centre_of_buoyancy;
  if (state.volume > 0)
    state.centre_of_buoyancy =
        pose.position +
        pose.orientation * (immersion.wet.inB(model.fluid_frame).moment / state.volume);
  return state;
}

/// Whether a body away from surfaces is in a fluid that does not lie above one: on land beside the
/// water, the air that is above the water does not make it wet.
bool isWetIn(const Medium& medium, const AmbientBody& ambient) {
  const auto& surfaces = ambient.models->surfaces;
  return medium.density > 0 &&
         std::none_of(surfaces.begin(), surfaces.end(), [&](const SurfaceMedia& surface) {
           return FluidKind(surface.kind.mediumAbove(ambient.def->medium)) == FluidKind(medium);
         });
}

WetState inRegion(const AmbientBody& ambient, const MotionView& now, const RegionsAround& around,
                  const FluidRegions& regions) {
  const FluidRegions::Entry& entry = *around.entry;
  if (!entry.region.surface)
    return wholly(ambient, now.state, isWetIn(entry.region.below, ambient));
  const Vector3 position = pointIn(entry.region, now.centre());
  const HoldAround* const hold = holdAround(ambient, regions, entry);
  const PoolSides sides =
      hold || around.is_alone ? PoolSides{} : findSides(ambient, now, regions, entry, 0);
  RegionCall call(regions);
  RegionSample sample = sampleRegion(entry.region, position, regions.time, ambient.def->medium);
  if (hold) {
    replaceSurfaceByHold(*hold, ambient, now, sample);
  } else if (needsStations(ambient, around)) {
    const StationSamples stations(ambient, now, regions, around, sample);
    stations.addMeans(&RegionSample::below, sample);
    stations.fitSurface(now.gravity, sample);
  }
  NearSurface near = nearSurface(ambient, now, SurfaceKind(entry.region), sample, position, 0);
  if (near.media < 0) return wholly(ambient, now.state, near.side != SurfaceSide::kAbove);
  if (sides.count > 0) near.plane_B.sides_F = &sides;
  return cutBy(near.plane_B, ambient.models->surfaces[static_cast<std::size_t>(near.media)].model,
               ambient, now.state);
}

/// Height above zero of the lowest corner of what is open of a hold; infinite: nothing is.
double lowestCorner(const VesselState& vessel, std::size_t hold, const Vector3& up_F) {
  double lowest = std::numeric_limits<double>::infinity();
  const auto look = [&](const HoldOpening& opening, std::size_t number) {
    if (vessel.changes.is_shut[number]) return;
    for (std::size_t i = 0; i < opening.outline.size(); i += 3)
      lowest = std::min(lowest, up_F.dot(Vector3(opening.outline[i], opening.outline[i + 1],
                                                 opening.outline[i + 2])));
  };
  std::size_t number = 0;
  for (std::size_t i = 0; i < vessel.shape->holds.size(); ++i)
    for (const HoldOpening& opening : vessel.shape->holds[i].openings) {
      if (i == hold) look(opening, number);
      ++number;
    }
  for (const AddedHole& hole : vessel.changes.holes) {
    if (hole.hold == static_cast<int>(hold)) look(openingOf(hole), number);
    ++number;
  }
  return lowest;
}

/// Returns the normal of the surface as the water sloshes: a plane that meets the walls where the
/// waves do, docs/theory.md eq. (154a).
Vector3 slopingNormal(const HoldModes& modes, const Sloshing& sloshing, const SurfacePlane& plane_F,
                      const Matrix3& R_WF) {
  Vector3 normal = plane_F.normal;
  if (!(plane_F.gravity > 0)) return normal;
  for (const SloshMode& mode : modes.modes)
    normal -= kWavePerPlane * mode.square / plane_F.gravity *
              mode.axis.dot(R_WF.transpose() * sloshing.displacement_W) * mode.axis;
  return normal.normalized();
}

/// @param plane_F normal of the level, and gravity as the water feels it
HoldWater waterIn(const VesselState& vessel, std::size_t i, const SurfacePlane& plane_F,
                  const Matrix3& R_WF) {
  const Vector3& up_F = plane_F.normal;
  const Hold& hold = vessel.shape->holds[i];
  const HoldState& state = vessel.holds[i];
  const HoldShape shape(hold);
  const HoldFill fill = fillHold(shape, up_F, state.filled());
  const WetVolume& wet = fill.water;
  HoldWater water;
  water.volume = state.volume;
  water.capacity = hold.volume;
  water.inflow = state.inflow;
  water.flooded = state.flooded;
  water.drained = state.drained;
  water.area = wet.waterplane.area;
  water.freeboard = lowestCorner(vessel, i, up_F) - fill.height;
  water.centre = wet.volume > 0 ? Vector3(wet.moment / wet.volume) : hold.centre;
  water.level = wet.waterplane.area > 0
                    ? wet.waterplane.centroid
                    : Vector3(hold.centre + (fill.height - up_F.dot(hold.centre)) * up_F);
  water.normal =
      slopingNormal(modesOf(shape, fill, plane_F), vessel.sloshing.now[i], plane_F, R_WF);
  if (wet.waterplane.area > 0) water.outline = cutAt(water.level, water.normal, hold.surface);
  return water;
}

}  // namespace

std::vector<HoldWater> holdsOf(const AmbientBody& ambient, const MotionView& now) {
  std::vector<HoldWater> all;
  if (!ambient.vessel) return all;
  const FrameOffset& frame = ambient.def->fluid_frame;
  const Matrix3 R = now.rotation() * frame.rotation;
  const Vector3 origin_W = now.centre() + now.rotation() * frame.translation;
  Vector3 up(0, 0, 1);
  double gravity = 0;
  if (ambient.surface()) {
    up = ambient.floating->plane_W.normal;
    gravity = ambient.floating->plane_W.gravity;
  } else if (!now.gravity.isZero(0)) {
    up = -now.gravity.normalized();
  }
  for (std::size_t i = 0; i < ambient.vessel->holds.size(); ++i) {
    HoldWater& water =
        all.emplace_back(waterIn(*ambient.vessel, i, {R.transpose() * up, 0, 0, gravity}, R));
    const HoldState& state = ambient.vessel->holds[i];
    constexpr double kFull = 1e-9;  // of a hold: less air is rounding
    const double room = water.capacity - state.filled();
    water.has_trapped_air = state.is_sealed && room > kFull * water.capacity;
    water.air_pressure = water.has_trapped_air ? state.air / room : ambient.def->holds.atmosphere;
    water.centre = origin_W + R * water.centre;
    water.level = origin_W + R * water.level;
    water.normal = R * water.normal;
    for (Vector3& point : water.outline) point = origin_W + R * point;
  }
  return all;
}

WetState wetStateOf(const AmbientBody& ambient, const MotionView& now,
                    const FluidRegions& regions) {
  long long asked = 0;
  RegionsAround around;
  if (ambient.def->follow_regions) around = findRegions(ambient, now, regions, 0, asked);
  if (!around.entry) return wholly(ambient, now.state, isWetIn(ambient.def->medium, ambient));
  WetState state = inRegion(ambient, now, around, regions);
  state.region = around.entry->id;
  return state;
}

}  // namespace ambient
