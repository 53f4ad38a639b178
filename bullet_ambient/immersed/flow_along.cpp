#include "bullet_ambient/immersed/flow_along.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium/profiles.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/spatial/rotation.h"

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
  const Vector3 offset = pointIn(pool, now.centre()) - now.centre();
  const Matrix3 to_body = now.rotation().transpose();
  for (int axis = 0; axis < 3; ++axis) {
    if (offset[axis] == 0) continue;
    if (!areUpright(now, axis)) return false;
    const Vector3 in_B = to_body * (std::copysign(1, offset[axis]) * Vector3::Unit(axis));
    if (!(reachAlong(model, in_B) > std::abs(offset[axis]))) return false;
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
      nearSurface(ambient, now, SurfaceKind(pool.region), sample, point, duration);
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
    const double offset = out * (place - centre[axis]);
    if (!(offset < model->radius)) continue;
    const Vector3 out_B = to_body * (out * Vector3::Unit(axis));
    const double high = reachAlong(*model, out_B);
    if (!(offset < high)) continue;
    Vector3 beyond = pointIn(pool.region, centre);
    beyond[axis] = place + out * (high - offset) / 2;
    if (isWaterAt(beyond, ambient, regions, pool.region)) continue;
    sides.of[sides.count++] = {frame.rotation.transpose() * out_B,
                               frame.rotation.transpose() * (offset * out_B - frame.translation)};
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
  SurfacePlane plane_B = ambient.flotation().plane;
  plane_B.sides_F = &before;
  WaterInside inside;
  const SurfacePlace at = placeAt(model, plane_B, {waterOf(ambient), &inside});
  const Matrix6 growth = ambient.flotation().inertia.full() - at.inertia.full();
  Twist relative = state.twist;
  relative.linear -= state.orientation.conjugate() * ambient.medium.velocity;
  const Vector6 x = relative.vector(), momentum = growth * x;
  return x.dot(momentum) > 0 ? Wrench::fromVector(-momentum / duration) : Wrench{};
}

}  // namespace

void findSidePush(AmbientBody& ambient, const MotionView& now, double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane& plane_F = flotationNow(ambient, now).immersion_F.plane;
  const Quaternion& q = now.state.orientation;
  FlowAlongBody& flow = *ambient.flow_along;
  flow.side_push_W = turned(q, model.fluid_frame.toB(computeSidePush(*model.hull, plane_F)));
  if (duration > 0) flow.growth_W = turned(q, resistanceOfGrowth(ambient, now.state, duration));
}

namespace {

constexpr double kWeight = BodyStations::kWeight;
// Largest k L of a body that takes a wave at one place: its heave errs by (k L)^2 / 24.
constexpr double kSmallAgainstWave = 0.3;

// True if the velocity along a body may change by jumps or in any other way, not by waves alone.
bool mayDiffer(const RegionsAround& around) {
  return !around.is_alone || (around.entry && hasFlow(around.entry->region));
}

bool isTaken(const RegionsAround& around, double length) {
  return length > 0 && (mayDiffer(around) || isLargeAgainstWaves(around.entry->region, length));
}

// Returns the surface of a region if it is no plane; null: there is none.
const WaterSurface* bendingSurface(const RegionEntry* entry) {
  if (!entry || !entry->region.surface) return nullptr;
  const WaterSurface* surface = entry->region.surface.get();
  return surface->waveNumber() > 0 ? surface : nullptr;
}

// Returns the one that is nearer to 0 if both have one sign, else 0.
double lesserOf(double a, double b) {
  if (!(a * b > 0)) return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

}  // namespace

bool isLargeAgainstWaves(const FluidRegion& region, double length) noexcept {
  return region.surface && region.surface->waveNumber() * length > kSmallAgainstWave;
}

bool needsStations(const AmbientBody& ambient, const RegionsAround& around) noexcept {
  if (!ambient.flow_along || (around.is_alone && !around.entry)) return false;
  return isTaken(around, ambient.models->stations.lengths.maxCoeff());
}

double halfHeight(const AmbientBody& ambient, const MotionView& now,
                  const FluidRegion& region) noexcept {
  if (!region.flow_above || !region.surface) return 0;
  const BodyStations& of_body = ambient.models->stations;
  const Vector3 up_B = now.state.orientation.conjugate() * region.surface->up();
  return (of_body.offsets_B.transpose() * up_B).cwiseAbs().sum() / std::sqrt(0.6);
}

StationSamples::StationSamples(const AmbientBody& ambient, const MotionView& now,
                               const FluidRegions& regions, const RegionsAround& around,
                               const RegionSample& centre) noexcept
    : centre_W_(now.centre()),
      to_world_(now.rotation()),
      centre_(centre),
      still_axis_B_(ambient.models->stations.still_axis_B),
      half_height_(around.entry ? halfHeight(ambient, now, around.entry->region) : 0),
      surface_(bendingSurface(around.entry)),
      may_turn_(mayDiffer(around)) {
  const BodyStations& of_body = ambient.models->stations;
  for (int axis = 0; axis < kPairs; ++axis) {
    if (!isTaken(around, of_body.lengths[axis])) continue;
    const Vector3 offset_W = to_world_ * of_body.offsets_B.col(axis);
    stations_[2 * axis].offset_W = offset_W;
    stations_[2 * axis + 1].offset_W = -offset_W;
    for (int side = 0; side < 2; ++side)
      sampleAt(ambient, regions, around, stations_[2 * axis + side]);
  }
}

void StationSamples::sampleAt(const AmbientBody& ambient, const FluidRegions& regions,
                              const RegionsAround& around, Station& station) noexcept {
  const Vector3 point_W = centre_W_ + station.offset_W;
  long long asked = 0;
  const RegionEntry* entry = around.is_alone ? around.entry : regions.index().find(point_W, asked);
  if (!entry) {
    station.sample.below = ambient.def->medium;
    return;
  }
  RegionCall call(regions);
  station.sample =
      sampleRegion(entry->region, point_W, regions.time, ambient.def->medium, half_height_);
  is_steady_ = is_steady_ && ambient::isSteady(entry->region);
  if (station.sample.is_finite) {
    station.has_surface = surface_ && entry->region.surface.get() == surface_;
  } else {
    is_finite_ = false;
    station.sample = centre_;
  }
}

Vector3 StationSamples::difference(int station, Medium RegionSample::*side,
                                   Vector3 Medium::*what) const {
  const Medium &there = stations_[station].sample.*side, &here = centre_.*side;
  if (!isUsed(station / 2) || !(FluidKind(there) == FluidKind(here))) return Vector3::Zero();
  return there.*what - here.*what;
}

Vector3 StationSamples::meanDifference(Medium RegionSample::*side, Vector3 Medium::*what) const {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 2 * kPairs; ++i) sum += kWeight * difference(i, side, what);
  return sum;
}

void StationSamples::addMeans(Medium RegionSample::*side, RegionSample& sample) const noexcept {
  Medium& medium = sample.*side;
  medium.velocity += meanDifference(side, &Medium::velocity);
  medium.acceleration += meanDifference(side, &Medium::acceleration);
}

void StationSamples::fitSurface(const Vector3& gravity, RegionSample& sample) const noexcept {
  if (!surface_ || !hasSurface(sample, gravity)) return;
  constexpr double kUpright = 1e-6;  // part of the squares that tells no slope of an upright axis
  const Vector3 up = -gravity.normalized(), felt = gravity - sample.below.acceleration;
  const Vector3 slope = up - felt / felt.dot(up);  // that of the plane across `felt`
  Matrix3 squares = Matrix3::Zero();
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 2 * kPairs; ++i) {
    const Station& station = stations_[i];
    if (!isUsed(i / 2) || !station.has_surface) continue;
    const double rise = up.dot(station.offset_W);
    const Vector3 offset = station.offset_W - rise * up;
    const double above =
        station.sample.height - centre_.height + rise - slope.dot(offset);  // that plane
    sample.height += kWeight * above;
    sum += kWeight * above * offset;
    squares += kWeight * offset * offset.transpose();
    squares += kUpright * kWeight * station.offset_W.squaredNorm() * Matrix3::Identity();
  }
  if (squares.trace() > 0) sample.tilt = squares.inverse() * sum;
}

StationSamples::AxisFlow StationSamples::alongAxis(int axis, Medium RegionSample::*side) const {
  const Matrix3 to_body = to_world_.transpose();
  const Vector3 ahead = to_body * difference(2 * axis, side, &Medium::velocity);
  const Vector3 behind = to_body * difference(2 * axis + 1, side, &Medium::velocity);
  AxisFlow flow;
  flow.offset_B = to_body * stations_[2 * axis].offset_W;
  for (int i = 0; i < 3; ++i) flow.even_B[i] = lesserOf(ahead[i], -behind[i]);
  flow.ahead_B = ahead - flow.even_B;
  flow.behind_B = behind + flow.even_B;
  flow.largest = std::max(ahead.norm(), behind.norm());
  flow.acceleration_B = to_body *
                        (difference(2 * axis, side, &Medium::acceleration) -
                         difference(2 * axis + 1, side, &Medium::acceleration)) /
                        2;
  return flow;
}

Vector3 StationSamples::turning(const AxisFlow (&axes)[kPairs], Vector3 AxisFlow::*ahead_B) {
  constexpr double kThin = 1e-9;  // part of the moments of inertia that an axis without them gets
  Matrix3 moments = Matrix3::Zero();
  Vector3 sum = Vector3::Zero();
  for (const AxisFlow& axis : axes) {
    moments += axis.offset_B.squaredNorm() * Matrix3::Identity() -
               axis.offset_B * axis.offset_B.transpose();
    sum += axis.offset_B.cross(axis.*ahead_B);
  }
  if (sum.isZero(0)) return sum;
  moments.diagonal().array() += kThin * moments.trace();
  return moments.inverse() * sum;
}

void StationSamples::divide(const AxisFlow& axis, FlowAlongBody& flow) {
  const Vector3 mean = kWeight * (axis.ahead_B + axis.behind_B);
  const Vector3 rest_B[] = {-mean, axis.ahead_B - mean, axis.behind_B - mean};
  const Vector3 offsets_B[] = {Vector3::Zero(), axis.offset_B, -axis.offset_B};
  flow.stations = 3;
  for (int i = 0; i < 3; ++i) {
    flow.twists_B[i] = {flow.twists_B[0].angular, rest_B[i]};
    flow.places_B[i] = offsets_B[i];
    flow.weights[i] = i == 0 ? 1 - 2 * kWeight : kWeight;
  }
}

FlowAlongBody StationSamples::flowAlong(Medium RegionSample::*side) const noexcept {
  constexpr double kEven = 1e-3;  // part of the differences, below the error of the loads
  AxisFlow axes[kPairs];
  const AxisFlow* most_uneven = axes;
  double largest = 0;
  for (int axis = 0; axis < kPairs; ++axis) {
    if (!isUsed(axis)) continue;
    axes[axis] = alongAxis(axis, side);
    largest = std::max(largest, axes[axis].largest);
    if (axes[axis].rest() > most_uneven->rest()) most_uneven = axes + axis;
  }
  FlowAlongBody flow;
  flow.spin_up_B = turning(axes, &AxisFlow::acceleration_B);
  flow.spin_up_B -= still_axis_B_.dot(flow.spin_up_B) * still_axis_B_;
  if (!may_turn_ || !(largest > 0)) return flow;
  flow.stations = 1;
  flow.weights[0] = 1;
  flow.twists_B[0].angular = turning(axes, &AxisFlow::even_B);
  if (most_uneven->rest() > kEven * largest) divide(*most_uneven, flow);
  return flow;
}

namespace {

// Returns the mass of the fluid that a body displaces [kg].
double displacedFluid(const AmbientBody& ambient) {
  const SurfaceModel* surface = ambient.surface();
  if (!surface) return ambient.model().displaced_mass;
  return surface->above.displaced_mass +
         surface->excess_density * ambient.flotation().immersion_F.wet.volume;
}

// Returns the wrench in B by which fluid that is spun up takes a body along, eq. (88).
Wrench pushBySpinUp(AmbientBody& ambient, const MotionView& now) {
  const SurfaceModel* const surface = ambient.surface();
  Matrix6 inertia = surface ? flotationNow(ambient, now).inertia.full() : ambient.model().inertia;
  if (surface && ambient.flotation().inside_F)
    inertia -= ambient.flotation().inside_F->inertia.full();
  const Vector3& rate = ambient.flow_along->spin_up_B;
  Wrench push = Wrench::fromVector(inertia.leftCols<3>() * rate);
  push.torque -= ambient.models->inverse_mass.moments().cwiseProduct(rate);
  const double mass = 2 * kWeight * displacedFluid(ambient);
  const Matrix3& offsets = ambient.models->stations.offsets_B;
  push.torque += mass * (offsets.squaredNorm() * rate - offsets * (offsets.transpose() * rate));
  return push;
}

// Returns the layers around a body; null: there are none.
const DensityLayers* layersAround(const AmbientBody& ambient, const FluidRegions& regions) {
  if (!regions.haveLayers() || ambient.location.is_above || ambient.in_hold >= 0) return nullptr;
  if (!(ambient.def->fluid_body->volume > 0)) return nullptr;
  const auto entry = regions.all().find(ambient.location.region);
  return entry == regions.all().end() ? nullptr : entry->second.region.layers.get();
}

// Returns the height along `up` of the surface at a body; infinite: it is all below.
double surfaceAt(const AmbientBody& ambient, const Vector3& up, const Vector3& centre) {
  if (!ambient.surface()) return std::numeric_limits<double>::infinity();
  const SurfacePlane& plane = ambient.floating->plane_W;
  return up.dot(centre) + plane.depth(centre) / plane.normal.dot(up);
}

// Finds what buoyancy in layers adds to that in a fluid of constant density, in the middle of the
// way that the velocity leads the body in the step, and multiplies AmbientBody::load_scale by the
// density there over that of the medium; eq. (180).
void findLayerPush(AmbientBody& ambient, const MotionView& now, const DensityLayers& layers,
                   double duration) {
  const FrameOffset& frame = ambient.def->fluid_frame;
  const double reference = ambient.medium.density, half = duration / 2;
  const Vector3 turn = half * now.twist_W.angular, &up = layers.up();
  const Matrix3 R = (rotationFromVector(turn) * now.state.orientation).toRotationMatrix();
  const Vector3 centre = now.centre() + half * now.twist_W.linear;
  const double surface = surfaceAt(ambient, up, centre);
  const LayeredBody body{*ambient.def->fluid_body, ambient.hull,
                         frame.rotation.transpose() * (R.transpose() * up),
                         up.dot(centre + R * frame.translation), surface};
  const ExcessFluid excess = findExcessFluid(body, layers, reference);
  const Vector3 moment_W = R * (frame.rotation * excess.moment + excess.mass * frame.translation);
  const Vector3 lift = ambient.medium.acceleration - now.gravity;
  ambient.flow_along->layers_W = {moment_W.cross(lift), excess.mass * lift};
  const double height = up.dot(centre + R * ambient.model().centre_of_volume);
  ambient.load_scale *= layers.density(std::min(height, surface)) / reference;
}

}  // namespace

void findPushes(AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                double duration) noexcept {
  if (!ambient.flow_along) return;
  if (const DensityLayers* layers = layersAround(ambient, regions))
    findLayerPush(ambient, now, *layers, duration);
  FlowAlongBody& flow = *ambient.flow_along;
  if (flow.sides_F.count > 0) findSidePush(ambient, now, duration);
  if (!flow.spin_up_B.isZero(0)) flow.push_B = pushBySpinUp(ambient, now);
  if (flow.stations == 0) return;
  if (!loadsOn(ambient)) {
    flow.stations = 0;
    return;
  }
  const SurfaceModel* surface = ambient.surface();
  flow.at_rest_B =
      surface
          ? loadBelow(*surface, flotationNow(ambient, now), {}, ambient.load_scale, &flow).wrench
          : computeSurfaceLoad(ambient.model(), {}, ambient.load_scale, &flow).wrench;
  countLoads(ambient, 1);
}

}  // namespace ambient
