#include "bullet_ambient/immersed/station_samples.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/immersed/region_call.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
namespace {

constexpr double kWeight = BodyStations::kWeight;
// Largest k L of a body that takes a wave at one place: its heave errs by (k L)^2 / 24.
constexpr double kSmallAgainstWave = 0.3;

bool isSmall(const FluidRegion& region, double length) {
  return !region.surface || !(region.surface->waveNumber() * length > kSmallAgainstWave);
}

// True if velocities along an axis may differ by anything.
bool mayDiffer(const RegionsAround& around) {
  return !around.is_alone || (around.entry && around.entry->region.flow);
}

bool isTaken(const RegionsAround& around, double length) {
  return length > 0 && (mayDiffer(around) || !isSmall(around.entry->region, length));
}

// Returns the surface of a region if it is no plane; null: there is none.
const WaterSurface* bendingSurface(const RegionEntry* entry) {
  if (!entry || !entry->region.surface) return nullptr;
  const WaterSurface* surface = entry->region.surface.get();
  return surface->waveNumber() > 0 ? surface : nullptr;
}

Vector3 upOf(const Vector3& gravity) { return -gravity.normalized(); }

}  // namespace

bool needsStations(const AmbientBody& ambient, const RegionsAround& around) noexcept {
  if (around.is_alone && !around.entry) return false;
  return isTaken(around, ambient.models->stations.lengths.maxCoeff());
}

StationSamples::StationSamples(const AmbientBody& ambient, const FluidRegions& regions,
                               const RegionsAround& around, const RegionSample& centre) noexcept
    : centre_W_(toVector3(ambient.body->getWorldTransform().getOrigin())),
      to_world_(toQuaternion(ambient.body->getWorldTransform().getRotation()).toRotationMatrix()),
      centre_(centre),
      surface_(bendingSurface(around.entry)),
      may_turn_(mayDiffer(around)) {
  const BodyStations& of_body = ambient.models->stations;
  for (int axis = 0; axis < kPairs; ++axis) {
    if (!isTaken(around, of_body.lengths[axis])) continue;
    const Vector3 way_W = to_world_ * of_body.ways_B.col(axis);
    stations_[2 * axis].way_W = way_W;
    stations_[2 * axis + 1].way_W = -way_W;
    for (int side = 0; side < 2; ++side) take(ambient, regions, around, stations_[2 * axis + side]);
  }
}

void StationSamples::take(const AmbientBody& ambient, const FluidRegions& regions,
                          const RegionsAround& around, Station& station) noexcept {
  const Vector3 point_W = centre_W_ + station.way_W;
  long long asked = 0;
  const RegionEntry* entry = around.is_alone ? around.entry : regions.find(point_W, asked);
  if (!entry) {
    station.sample.below = ambient.def->medium;
    return;
  }
  RegionCall call(regions);
  station.sample = sampleRegion(entry->region, point_W, regions.time, ambient.def->medium);
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
  const Vector3 up = upOf(gravity), felt = gravity - sample.below.acceleration;
  const Vector3 slope = up - felt / felt.dot(up);  // that of the plane across `felt`
  Matrix3 squares = Matrix3::Zero();
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 2 * kPairs; ++i) {
    const Station& station = stations_[i];
    if (!isUsed(i / 2) || !station.has_surface) continue;
    const double rise = up.dot(station.way_W);
    const Vector3 way = station.way_W - rise * up;
    const double above =
        station.sample.height - centre_.height + rise - slope.dot(way);  // that plane
    sample.height += kWeight * above;
    sum += kWeight * above * way;
    squares += kWeight * way * way.transpose();
    squares += kUpright * kWeight * station.way_W.squaredNorm() * Matrix3::Identity();
  }
  if (squares.trace() > 0) sample.tilt = squares.inverse() * sum;
}

// Returns the angular velocity of the rigid motion nearest to the velocities [rad/s].
Vector3 StationSamples::turning(Medium RegionSample::*side) const {
  constexpr double kThin = 1e-9;  // part of the moments of inertia that an axis without them gets
  Matrix3 moments = Matrix3::Zero();
  Vector3 sum = Vector3::Zero();
  for (int axis = 0; axis < kPairs; ++axis) {
    if (!isUsed(axis)) continue;
    const Vector3& way = stations_[2 * axis].way_W;
    moments += 2 * kWeight * (way.squaredNorm() * Matrix3::Identity() - way * way.transpose());
    sum += kWeight * way.cross(difference(2 * axis, side, &Medium::velocity) -
                               difference(2 * axis + 1, side, &Medium::velocity));
  }
  if (sum.isZero(0)) return sum;
  moments.diagonal().array() += kThin * moments.trace();
  return moments.inverse() * sum;
}

FlowAlongBody StationSamples::alongAxis(int axis, const Vector3 (&rest_W)[3],
                                        const Vector3& turn_W) const {
  FlowAlongBody flow;
  const Matrix3 to_body = to_world_.transpose();
  const double weights[] = {1 - 2 * kWeight, kWeight, kWeight};
  Vector3 mean = Vector3::Zero();
  for (int i = 0; i < 3; ++i) mean += weights[i] * rest_W[i];
  flow.stations = axis < 0 ? 1 : 3;
  for (int i = 0; i < flow.stations; ++i) {
    flow.twists_B[i].angular = to_body * turn_W;
    if (axis >= 0) flow.twists_B[i].linear = to_body * (rest_W[i] - mean);
    flow.weights[i] = axis < 0 ? 1 : weights[i];
  }
  return flow;
}

FlowAlongBody StationSamples::flowAlong(Medium RegionSample::*side) const noexcept {
  constexpr double kRigid = 1e-3;  // part of the differences, below the error of the loads
  if (!may_turn_) return {};
  const Vector3 mean = meanDifference(side, &Medium::velocity);
  const Vector3 turn = turning(side);
  double largest = 0, most = 0;
  int along = -1;
  Vector3 rest_W[3] = {-mean, Vector3::Zero(), Vector3::Zero()};
  for (int axis = 0; axis < kPairs; ++axis) {
    if (!isUsed(axis)) continue;
    Vector3 rest[2];
    for (int i = 0; i < 2; ++i) {
      const Vector3 apart = difference(2 * axis + i, side, &Medium::velocity);
      rest[i] = apart - mean - turn.cross(stations_[2 * axis + i].way_W);
      largest = std::max(largest, apart.norm());
    }
    const double size = std::max({rest[0].norm(), rest[1].norm(), (rest[0] - rest[1]).norm()});
    if (!(size > most)) continue;
    most = size;
    along = axis;
    rest_W[1] = rest[0];
    rest_W[2] = rest[1];
  }
  if (!(largest > 0)) return {};
  return alongAxis(most > kRigid * largest ? along : -1, rest_W, turn);
}

void findLoadAtRest(AmbientBody& ambient) noexcept {
  FlowAlongBody& flow = ambient.flow_along;
  if (flow.stations == 0) return;
  if (!loadsOn(ambient)) {
    flow.stations = 0;
    return;
  }
  const SurfaceModel* surface = ambient.surface();
  flow.at_rest_B =
      surface ? loadBelow(*surface, standNow(ambient), {}, {ambient.load_share, &flow}).wrench
              : computeSurfaceLoad(ambient.model(), {}, ambient.load_share, &flow).wrench;
  countLoads(ambient, 1);
}

AMBIENT_END
