#include "bullet_ambient/immersed/pool_rim.h"

#include <cmath>

#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {
namespace {

// Largest cosine between the normal of a side of a pool and the vertical.
constexpr double kUpright = 0.7;

// Returns the model of a body that sides may cut; null: it has none.
const SurfaceModel* modelIn(const AmbientBody& ambient, const FluidRegion& pool) {
  if (!ambient.flow_along || !pool.bounds || !pool.surface) return nullptr;
  const int media = ambient.models->findSurface(SurfaceKind(pool));
  if (media < 0) return nullptr;
  const SurfaceModel& model = ambient.models->surfaces[static_cast<std::size_t>(media)].model;
  return model.hull ? &model : nullptr;
}

// Returns how far a body reaches along a direction in B from its centre of mass [m].
double reachAlong(const SurfaceModel& model, const Vector3& along_B) {
  const FrameOffset& frame = model.fluid_frame;
  return computeExtent(*model.hull, frame.rotation.transpose() * along_B).second +
         along_B.dot(frame.translation);
}

// True if sides of a pool across an axis of W are upright.
bool areUpright(const MotionView& now, int axis) {
  return std::abs(now.gravity.normalized()[axis]) <= kUpright;
}

// True if what is at a point beyond a side is a liquid, too, or has a surface.
bool isWaterAt(const Vector3& point_W, const AmbientBody& ambient, const FluidRegions& regions,
               const FluidRegion& pool) {
  constexpr double kLiquid = 0.5;  // of the density of the pool
  long long asked = 0;
  const RegionEntry* entry = regions.index().find(point_W, asked);
  if (entry && entry->region.surface) return true;
  const double density = entry ? entry->region.below.density : ambient.def->medium.density;
  return density > kLiquid * pool.below.density;
}

// True if a body outside of a pool, at the height of its bounds, reaches over its rim.
bool reachesOver(const MotionView& now, const FluidRegion& pool, const SurfaceModel& model) {
  const Vector3 way = pointIn(pool, now.centre()) - now.centre();
  const Matrix3 to_body = now.rotation().transpose();
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) continue;
    if (!areUpright(now, axis)) return false;
    const Vector3 in_B = to_body * (std::copysign(1, way[axis]) * Vector3::Unit(axis));
    if (!(reachAlong(model, in_B) > std::abs(way[axis]))) return false;
  }
  return true;
}

// True if a body outside of a pool reaches into its water in a step.
bool reachesInto(const AmbientBody& ambient, const MotionView& now, const RegionEntry& pool,
                 const FluidRegions& regions, double duration) {
  const SurfaceModel* model = modelIn(ambient, pool.region);
  if (!model || !reachesOver(now, pool.region, *model)) return false;
  const Vector3 point = pointIn(pool.region, now.centre());
  long long asked = 0;
  if (regions.index().find(point, asked) != &pool) return false;
  if (findSides(ambient, now, regions, pool, 0).count == 0) return false;
  RegionCall call(regions);
  const RegionSample sample = sampleRegion(pool.region, point, regions.time, ambient.def->medium);
  const NearSurface near =
      nearSurface(ambient, now, SurfaceKind(pool.region), {sample, point}, duration);
  return sample.is_finite && near.media >= 0 && near.side != SurfaceSide::kAbove;
}

}  // namespace

Vector3 pointIn(const FluidRegion& region, const Vector3& centre_W) noexcept {
  Vector3 point = centre_W;
  if (!region.bounds || region.bounds->hold(centre_W)) return point;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = region.bounds->lowest[axis], high = region.bounds->highest[axis];
    if (point[axis] < low) point[axis] = low;
    if (point[axis] >= high) point[axis] = std::nextafter(high, low);
  }
  return point;
}

RegionsAround findRegions(const AmbientBody& ambient, const MotionView& now,
                          const FluidRegions& regions, double duration, long long& asked) noexcept {
  const Vector3& centre = now.centre();
  const double reach = ambient.models->reach;
  RegionsAround around = regions.index().findAround(centre, reach, asked);
  if (around.is_alone || (around.entry && around.entry->region.surface)) return around;
  const RegionEntry* pool = regions.index().findPool(centre, reach, asked);
  if (pool && reachesInto(ambient, now, *pool, regions, duration)) around.entry = pool;
  return around;
}

PoolSides findSides(const AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                    const RegionEntry& pool, double ahead) noexcept {
  PoolSides sides;
  const SurfaceModel* model = modelIn(ambient, pool.region);
  if (!model) return sides;
  const Matrix3 to_body = now.rotation().transpose();
  const Vector3 centre = now.centre() + ahead * now.twist_W.linear;
  const FrameOffset& frame = model->fluid_frame;
  for (int wall = 0; wall < 6 && sides.count < PoolSides::kMost; ++wall) {
    const int axis = wall / 2, out = wall % 2 ? 1 : -1;
    if (!areUpright(now, axis)) continue;
    const RegionBounds& bounds = *pool.region.bounds;
    const double place = (out < 0 ? bounds.lowest : bounds.highest)[axis];
    const double way = out * (place - centre[axis]);
    if (!(way < model->radius)) continue;
    const Vector3 out_B = to_body * (out * Vector3::Unit(axis));
    const double high = reachAlong(*model, out_B);
    if (!(way < high)) continue;
    Vector3 beyond = pointIn(pool.region, centre);
    beyond[axis] = place + out * (high - way) / 2;
    if (isWaterAt(beyond, ambient, regions, pool.region)) continue;
    sides.of[sides.count++] = {frame.rotation.transpose() * out_B,
                               frame.rotation.transpose() * (way * out_B - frame.translation)};
  }
  return sides;
}

namespace {

// Returns the wrench in B by which a body keeps its momentum as the part of it that is in the pool
// grows; none where it becomes smaller. The step before had the sides where they were a step ago.
Wrench resistanceOfGrowth(const AmbientBody& ambient, const RigidState& state, double duration) {
  const SurfaceModel& model = *ambient.surface();
  const Vector3 velocity_F = model.fluid_frame.rotation.transpose() * state.twist.linear;
  PoolSides before = ambient.flow_along->sides_F;
  for (int i = 0; i < before.count; ++i) {
    PoolSides::Side& side = before.of[i];
    side.point += duration * velocity_F.dot(side.normal) * side.normal;
  }
  SurfacePlane plane_B = ambient.stand().plane;
  plane_B.sides_F = &before;
  WaterInside inside;
  const SurfacePlace at = placeAt(model, plane_B, {waterOf(ambient), &inside});
  const Matrix6 growth = ambient.stand().inertia.full() - at.inertia.full();
  Twist relative = state.twist;
  relative.linear -= state.orientation.conjugate() * ambient.medium.velocity;
  const Vector6 x = relative.vector(), momentum = growth * x;
  return x.dot(momentum) > 0 ? Wrench::fromVector(-momentum / duration) : Wrench{};
}

}  // namespace

void findSidePush(AmbientBody& ambient, const MotionView& now, double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane& plane_F = standNow(ambient, now).immersion_F.plane;
  const Quaternion& q = now.state.orientation;
  const auto inWorld = [&q](const Wrench& f) { return Wrench{q * f.torque, q * f.force}; };
  FlowAlongBody& flow = *ambient.flow_along;
  flow.side_push_W = inWorld(model.fluid_frame.toB(computeSidePush(*model.hull, plane_F)));
  if (duration > 0) flow.growth_W = inWorld(resistanceOfGrowth(ambient, now.state, duration));
}

}  // namespace ambient
