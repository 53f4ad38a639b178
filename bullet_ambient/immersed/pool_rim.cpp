#include "bullet_ambient/immersed/pool_rim.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/immersed/region_call.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
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
std::pair<double, double> reachAlong(const SurfaceModel& model, const Vector3& along_B) {
  const FrameOffset& frame = model.fluid_frame;
  const auto [low, high] = computeExtent(*model.hull, frame.rotation.transpose() * along_B);
  const double middle = along_B.dot(frame.translation);
  return {low + middle, high + middle};
}

// A vertical side of a pool: its axis in W, 1 or -1 for its way out, and its place [m].
struct Wall {
  int axis;
  double out, place;

  Vector3 normal_W() const { return out * Vector3::Unit(axis); }
};

// Calls visit(wall) for the vertical sides of bounds.
template <class Visit>
void forEachWall(const RegionBounds& bounds, const btVector3& gravity, const Visit& visit) {
  const Vector3 down = toVector3(gravity).normalized();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(down[axis]) <= kUpright)) continue;
    visit(Wall{axis, -1, bounds.lowest[axis]});
    visit(Wall{axis, 1, bounds.highest[axis]});
  }
}

// True if what is at a point beyond a side is a liquid, too, or has a surface.
bool isWaterAt(const Vector3& point_W, const AmbientBody& ambient, const FluidRegions& regions,
               const FluidRegion& pool) {
  constexpr double kLiquid = 0.5;  // of the density of the pool
  long long asked = 0;
  const RegionEntry* entry = regions.find(point_W, asked);
  if (entry && entry->region.surface) return true;
  const double density = entry ? entry->region.below.density : ambient.def->medium.density;
  return density > kLiquid * pool.below.density;
}

// True if a body outside of a pool reaches beyond its rim, and not over the height of its bounds.
bool reachesOver(const AmbientBody& ambient, const RegionEntry& pool, const SurfaceModel& model) {
  const Vector3 centre = centreOf(ambient);
  const Matrix3 to_body =
      toQuaternion(ambient.body->getWorldTransform().getRotation()).toRotationMatrix().transpose();
  RegionBounds above = *pool.region.bounds;
  bool reaches = true;
  forEachWall(*pool.region.bounds, ambient.body->getGravity(), [&](const Wall& wall) {
    const double inside = wall.out * (wall.place - centre[wall.axis]);
    if (inside < 0)
      reaches = reaches && inside > reachAlong(model, to_body * wall.normal_W()).first;
    above.lowest[wall.axis] = above.highest[wall.axis] = centre[wall.axis];
  });
  return reaches && (centre.array() >= above.lowest.array()).all() &&
         (centre.array() <= above.highest.array()).all();
}

// True if a body outside of a pool reaches into its water in a step.
bool reachesInto(const AmbientBody& ambient, const RegionEntry& pool, const FluidRegions& regions,
                 double duration) {
  const SurfaceModel* model = modelIn(ambient, pool.region);
  if (!model || !reachesOver(ambient, pool, *model)) return false;
  const Vector3 point = pointIn(pool.region, centreOf(ambient));
  long long asked = 0;
  if (regions.find(point, asked) != &pool) return false;
  if (findSides(ambient, regions, pool, 0).count == 0) return false;
  RegionCall call(regions);
  const RegionSample sample = sampleRegion(pool.region, point, regions.time, ambient.def->medium);
  const NearSurface near =
      nearSurface(ambient, SurfaceKind(pool.region), {sample, point}, duration);
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

RegionsAround findRegions(const AmbientBody& ambient, const FluidRegions& regions, double duration,
                          long long& asked) noexcept {
  const Vector3 centre = centreOf(ambient);
  const double reach = ambient.models->reach;
  RegionsAround around = regions.findAround(centre, reach, asked);
  if (around.is_alone || (around.entry && around.entry->region.surface)) return around;
  const RegionEntry* pool = regions.findPool(centre, reach, asked);
  if (pool && reachesInto(ambient, *pool, regions, duration)) around.entry = pool;
  return around;
}

PoolSides findSides(const AmbientBody& ambient, const FluidRegions& regions,
                    const RegionEntry& pool, double ahead) noexcept {
  PoolSides sides;
  const SurfaceModel* model = modelIn(ambient, pool.region);
  if (!model) return sides;
  const btRigidBody& body = *ambient.body;
  const Matrix3 to_body =
      toQuaternion(body.getWorldTransform().getRotation()).toRotationMatrix().transpose();
  const Vector3 centre = centreOf(ambient) + ahead * toVector3(body.getLinearVelocity());
  const FrameOffset& frame = model->fluid_frame;
  forEachWall(*pool.region.bounds, body.getGravity(), [&](const Wall& wall) {
    const double way = wall.out * (wall.place - centre[wall.axis]);
    if (!(way < model->radius) || sides.count == PoolSides::kMost) return;
    const Vector3 out_B = to_body * wall.normal_W();
    const double high = reachAlong(*model, out_B).second;
    if (!(way < high)) return;
    Vector3 beyond = pointIn(pool.region, centre);
    beyond[wall.axis] = wall.place + wall.out * (high - way) / 2;
    if (isWaterAt(beyond, ambient, regions, pool.region)) return;
    sides.of[sides.count++] = {frame.rotation.transpose() * out_B,
                               frame.rotation.transpose() * (way * out_B - frame.translation)};
  });
  return sides;
}

namespace {

// Returns the wrench in B by which a body keeps its momentum as the part of it that is in the pool
// grows; none where it becomes smaller. The step before had the sides where they were a step ago.
Wrench resistanceOfGrowth(const AmbientBody& ambient, double duration) {
  const SurfaceModel& model = *ambient.surface();
  const RigidState state = readState(*ambient.body);
  const Vector3 velocity_F = model.fluid_frame.rotation.transpose() * state.twist.linear;
  PoolSides before = ambient.flow_along->sides_F;
  for (int i = 0; i < before.count; ++i) {
    PoolSides::Side& side = before.of[i];
    side.point += duration * velocity_F.dot(side.normal) * side.normal;
  }
  SurfacePlane plane_B = ambient.stand().plane;
  plane_B.sides_F = &before;
  const Matrix6 growth = ambient.stand().inertia.full() - placeAt(model, plane_B).inertia.full();
  Twist relative = state.twist;
  relative.linear -= state.orientation.conjugate() * ambient.medium.velocity;
  const Vector6 x = relative.vector(), momentum = growth * x;
  return x.dot(momentum) > 0 ? Wrench::fromVector(-momentum / duration) : Wrench{};
}

}  // namespace

void findSidePush(AmbientBody& ambient, double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane& plane_F = standNow(ambient).immersion_F.plane;
  const Quaternion q = toQuaternion(ambient.body->getWorldTransform().getRotation());
  const auto inWorld = [&q](const Wrench& f) { return Wrench{q * f.torque, q * f.force}; };
  FlowAlongBody& flow = *ambient.flow_along;
  flow.side_push_W = inWorld(model.fluid_frame.toB(computeSidePush(*model.hull, plane_F)));
  if (duration > 0) flow.growth_W = inWorld(resistanceOfGrowth(ambient, duration));
}

AMBIENT_END
