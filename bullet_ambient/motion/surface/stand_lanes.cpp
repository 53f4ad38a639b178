#include "bullet_ambient/motion/surface/stand_lanes.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/flight/flight.h"

namespace ambient {
namespace {

constexpr int kSpread[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

void setPlane(StandLanes& lanes, int body, const SurfacePlane& plane) {
  setLane(lanes.normal, body, plane.normal);
  lanes.height[body] = plane.height;
  lanes.gravity[body] = plane.gravity;
  lanes.specific_weight[body] = plane.density * plane.gravity;
}

void setWetVolume(StandLanes& lanes, int body, const WetVolume& wet) {
  lanes.volume[body] = wet.volume;
  lanes.depth_integral[body] = wet.depth_integral;
  setLane(lanes.moment, body, wet.moment);
}

/// Added mass along the normal per unit density, without its factor, times c of docs/theory.md
/// eq. (69) [m^3].
double heaveInertia(const SurfaceModel& model, const SurfacePlace& place) {
  if (!(model.excess_density > 0)) return 0;
  const Vector3& s = place.plane.normal;
  const Matrix3 fluid = place.inertia.bottomRight() - model.above.inertia.bottomRightCorner<3, 3>();
  const double heave = model.heave_factor / model.added_density * s.dot(fluid * s);
  // The volume outside counts, and the factors are those of the added mass alone.
  const double inside = place.inside_F ? -place.inside_F->below.volume : 0;
  const double factors = model.heave_factor * (model.excess_density / model.added_density);
  return std::max(0.0, inside > 0 ? heave + (1 - factors) * inside : heave);
}

}  // namespace

void setPlace(StandLanes& lanes, int body, const SurfaceModel& model,
              const SurfacePlace& place) noexcept {
  setPlane(lanes, body, place.plane);
  const WetVolume wet = wetVolume(model, place);
  setWetVolume(lanes, body, wet);
  const Waterplane& section = wet.waterplane;
  lanes.area[body] = section.area;
  setLane(lanes.centroid, body, section.centroid);
  for (int i = 0; i < 6; ++i) lanes.spread[i][body] = section.spread(kSpread[i][0], kSpread[i][1]);
  lanes.heave_inertia[body] = heaveInertia(model, place);
  lanes.damping[body] = model.wave_damping;
  setLane(lanes.inertia, body, place.inertia);
  setLane(lanes.least, body, SymmetricMatrix(kLeastShare * model.above.inertia));
}

void setStand(StandLanes& lanes, int body, const SurfaceModel& model,
              const SurfaceStand& stand) noexcept {
  setPlane(lanes, body, stand.plane);
  setWetVolume(lanes, body, wetVolume(model, stand));
  forEachNumber(lanes.modes, stand.modes,
                [&](FlightLane& to, const double& from) { to[body] = from; });
}

void readStand(const StandLanes& lanes, int body, SurfaceStand& stand) noexcept {
  stand.inverse = symmetricOf(lanes.inverse, body);
  forEachNumber(stand.modes, lanes.modes,
                [&](double& to, const FlightLane& from) { to = from[body]; });
  stand.frequency = lanes.frequency[body];
}

void computeStands(StandLanes& lanes, const SurfaceModel* const* models,
                   SurfacePlace* const* places, int count) noexcept {
  kSurfaceKernels.fastest()->stand(lanes);
  const auto isIndefinite = [&](int i) {
    return lanes.active[i] > 0 && lanes.is_indefinite[i] > 0;
  };
  bool is_any = false;
  for (int i = 0; i < count; ++i) {
    if (!isIndefinite(i)) continue;
    is_any = true;
    SymmetricMatrix& inertia = places[i]->inertia;
    inertia = SymmetricMatrix(positiveInertia(*models[i], inertia.full()));
    setPlace(lanes, i, *models[i], *places[i]);
    setLane(lanes.least, i, SymmetricMatrix(Matrix6::Zero()));
  }
  if (!is_any) return;
  kSurfaceKernels.fastest()->stand(lanes);
  for (int i = 0; i < count; ++i)
    if (isIndefinite(i))
      setLane(lanes.inverse, i, SymmetricMatrix(models[i]->above.inverse_inertia));
}

void completeStands(const SurfaceModel* const* models, SurfaceStand* const* stands,
                    int count) noexcept {
  AMBIENT_ASSERT(count >= 0 && count <= kFlightLanes);
  StandLanes lanes{};
  SurfacePlace* places[kFlightLanes] = {};
  for (int i = 0; i < count; ++i) {
    lanes.active[i] = 1;
    setPlace(lanes, i, *models[i], *stands[i]);
    places[i] = stands[i];
  }
  computeStands(lanes, models, places, count);
  for (int i = 0; i < count; ++i) {
    readStand(lanes, i, *stands[i]);
  }
}

SurfaceStand standAtSurface(const SurfaceModel& model, const SurfacePlane& plane_B,
                            const VesselWater& water) noexcept {
  SurfaceStand stand;
  static_cast<SurfacePlace&>(stand) = placeAt(model, plane_B, water);
  const SurfaceModel* const models = &model;
  SurfaceStand* const stands = &stand;
  completeStands(&models, &stands, 1);
  return stand;
}

}  // namespace ambient
