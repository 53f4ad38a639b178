#include "bullet_ambient/motion/surface/flotation_lanes.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/flight/flight.h"

namespace ambient {
namespace {

constexpr int kSpread[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

void setPlane(FlotationLanes& lanes, int body, const SurfacePlane& plane) {
  setLane(lanes.normal, body, plane.normal);
  lanes.height[body] = plane.height;
  lanes.gravity[body] = plane.gravity;
  lanes.specific_weight[body] = plane.density * plane.gravity;
}

void setWetVolume(FlotationLanes& lanes, int body, const WetVolume& wet) {
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

void setPlace(FlotationLanes& lanes, int body, const SurfaceModel& model,
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

void setFlotation(FlotationLanes& lanes, int body, const SurfaceModel& model,
                  const Flotation& flotation) noexcept {
  setPlane(lanes, body, flotation.plane);
  setWetVolume(lanes, body, wetVolume(model, flotation));
  forEachNumber(lanes.modes, flotation.modes,
                [&](FlightLane& to, const double& from) { to[body] = from; });
}

void readFlotation(const FlotationLanes& lanes, int body, Flotation& flotation) noexcept {
  flotation.inverse = symmetricOf(lanes.inverse, body);
  forEachNumber(flotation.modes, lanes.modes,
                [&](double& to, const FlightLane& from) { to = from[body]; });
  flotation.frequency = lanes.frequency[body];
}

void setMoved(WaterLanes& lanes, int body, const WaterMoved& moved) noexcept {
  setLane(lanes.change, body, moved.inertia);
  setLane(lanes.momentum, body, moved.given);
  lanes.energy2[body] = moved.energy2;
}

void setSlosh(WaterLanes& lanes, int body, const SloshingAt& at, std::size_t hold, double damping,
              const Sloshing& state, SloshAlong (&own)[2]) noexcept {
  for (int i = 0; i < 2; ++i) {
    const SloshMode& mode = at.modes[hold].modes[i];
    if (!(mode.volume > 0)) continue;
    own[i] = SloshAlong(at, mode, damping, state);
    forEachNumber(lanes.slosh[i], own[i].mode,
                  [&](FlightLane& to, const double& from) { to[body] = from; });
  }
}

void moveSlosh(const WaterLanes& lanes, int body, const SloshAlong (&own)[2],
               Sloshing* state) noexcept {
  for (int i = 0; i < 2; ++i) {
    const SloshOf<FlightLane>& slosh = lanes.slosh[i];
    if (slosh.mass[body] > 0) own[i].move(slosh.way[body], slosh.velocity[body], *state);
  }
}

void computeFlotations(FlotationLanes& lanes, const SurfaceModel* const* models,
                       SurfacePlace* const* places, int count) noexcept {
  kSurfaceKernels.fastest()->computeFlotations(lanes);
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
  kSurfaceKernels.fastest()->computeFlotations(lanes);
  for (int i = 0; i < count; ++i)
    if (isIndefinite(i))
      setLane(lanes.inverse, i, SymmetricMatrix(models[i]->above.inverse_inertia));
}

void completeFlotations(const SurfaceModel* const* models, Flotation* const* flotations,
                        int count) noexcept {
  AMBIENT_ASSERT(count >= 0 && count <= kFlightLanes);
  FlotationLanes lanes{};
  SurfacePlace* places[kFlightLanes] = {};
  for (int i = 0; i < count; ++i) {
    lanes.active[i] = 1;
    setPlace(lanes, i, *models[i], *flotations[i]);
    places[i] = flotations[i];
  }
  computeFlotations(lanes, models, places, count);
  for (int i = 0; i < count; ++i) {
    readFlotation(lanes, i, *flotations[i]);
  }
}

Flotation flotationAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                      const VesselWater& water) noexcept {
  Flotation flotation;
  static_cast<SurfacePlace&>(flotation) = placeAt(model, plane_B, water);
  const SurfaceModel* const models = &model;
  Flotation* const flotations = &flotation;
  completeFlotations(&models, &flotations, 1);
  return flotation;
}

}  // namespace ambient
