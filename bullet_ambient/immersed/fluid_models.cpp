#include "bullet_ambient/immersed/fluid_models.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

Matrix6 makeVelocityBasis(const Matrix6& inertia, double mass, const Vector3& moments) {
  AMBIENT_ASSERT(moments.minCoeff() > 0 && mass > 0);
  Vector6 scale;
  scale << moments.cwiseSqrt(), Vector3::Constant(std::sqrt(mass));
  return Cholesky<6>(inertia).inverseTransposed() * scale.asDiagonal();
}

BodyStations makeBodyStations(const AttachDef& def) {
  constexpr double kShort = 0.2;  // length relative to the longest axis
  const FluidBody& shape = *def.fluid_body;
  const Matrix3& inertia =
      shape.volume > 0 ? shape.uniform_mass.inertia : shape.surface_mass.inertia;
  BodyStations stations;
  if (!inertia.allFinite() || !(inertia.trace() > 0)) return stations;
  const PrincipalFrame principal = findPrincipalFrame((inertia + inertia.transpose()) / 2);
  // Mean square distance along each axis: half the trace less the moment about the axis.
  const Vector3 squares =
      (Vector3::Constant(principal.moments.sum() / 2) - principal.moments).cwiseMax(0);
  const Vector3 lengths = (12 * squares).cwiseSqrt();
  const Matrix3 axes_B = def.fluid_frame.rotation * principal.rotation;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(lengths[axis] > kShort * lengths.maxCoeff())) continue;
    stations.lengths[axis] = lengths[axis];
    const double offset = std::sqrt(0.6) / 2 * lengths[axis];
    stations.offsets_B.col(axis) = offset * axes_B.col(axis);
    stations.reach = std::max(stations.reach, offset);
  }
  stations.still_axis_B = def.fluid_frame.rotation * axisOfRevolution(shape);
  return stations;
}

namespace {

template <class Entries, class Kind>
auto findKind(const Entries& entries, const Kind& kind) {
  return std::find_if(entries.begin(), entries.end(),
                      [&](const auto& entry) { return entry.kind == kind; });
}

MassProperties propertiesOf(const InverseMass& mass) {
  return {1 / mass.mass, mass.moments().asDiagonal()};
}

// A double holds no sum of masses of which one is 2^52 times the other.
void checkFluidMass(const FluidBody& shape, const BodyModel& model) {
  const double of_fluid = std::max(model.displaced_mass, model.largest_mass - model.mass);
  if (!(of_fluid <= std::ldexp(model.mass, std::numeric_limits<double>::digits - 1)))
    reject(shape, "mass of the medium that it displaces or moves [kg]", of_fluid,
           "at most 2^52 times its own; are its size and the density in SI units?");
}

MediumModel inMedium(const AttachDef& def, const InverseMass& mass, const FluidKind& kind,
                     const std::shared_ptr<const SurfaceLoads>& loads) {
  const BodyModel model =
      makeBodyModel(*def.fluid_body, def.fluid_frame, propertiesOf(mass), kind.medium(), loads,
                    {HoldContent::kFull, def.added_mass_factor, def.load_factor});
  checkFluidMass(*def.fluid_body, model);
  return {kind, model, makeVelocityBasis(model.inertia, model.mass, mass.moments())};
}

SurfaceMedia atSurface(const AttachDef& def, const InverseMass& mass, const SurfaceKind& kind) {
  SurfaceModelDef model;
  model.shape = def.fluid_body;
  model.fluid_frame = def.fluid_frame;
  model.mass = propertiesOf(mass);
  model.above = kind.mediumAbove(def.medium);
  model.below = kind.below.medium();
  // Whether it blows decides on loads.
  if (kind.may_blow) model.above.velocity = Vector3::Ones();
  model.flow = def.flow;
  model.wave_damping = def.wave_damping;
  model.added_mass_factor = def.added_mass_factor;
  model.load_factor = def.load_factor;
  return {kind, makeSurfaceModel(model)};
}

FluidModels makeModels(const AttachDef& def, const InverseMass& mass, const RegionFluids& fluids) {
  FluidModels models{mass, {}, {}, makeBodyStations(def), 0};
  const auto add = [&](const FluidKind& kind, const Medium& medium) {
    const auto loads = makeSurfaceLoads(def.fluid_body, medium, def.flow);
    models.media.push_back(inMedium(def, mass, kind, loads));
  };
  const FluidKind own(def.medium);
  add(own, def.medium);
  if (!def.follow_regions) return models;
  for (const FluidKind& kind : fluids.media)
    if (!(kind == own)) add(kind, kind.medium());
  for (const SurfaceKind& kind : fluids.surfaces)
    models.surfaces.push_back(atSurface(def, mass, kind));
  models.reach = models.stations.reach;
  if (!models.surfaces.empty())
    models.reach = std::max(models.reach, models.surfaces.front().model.radius);
  return models;
}

using Key = std::vector<double>;

template <class... Numbers>
void append(Key& key, Numbers... numbers) {
  key.insert(key.end(), {static_cast<double>(numbers)...});
}
void append(Key& key, const Vector3& v) { append(key, v.x(), v.y(), v.z()); }
void append(Key& key, const FluidKind& kind) { append(key, kind.density, kind.viscosity); }

// Returns the numbers of a definition that its models depend on.
Key keyOf(const AttachDef& def) {
  const FlowSettings& flow = def.flow;
  Key key;
  key.reserve(64);
  append(key, FluidKind(def.medium));
  append(key, def.follow_regions, def.wave_damping, def.added_mass_factor, def.load_factor,
         flow.separation_angle, flow.roughness, flow.skin_friction, flow.precision,
         flow.maximum_load_error, flow.law, flow.stall_lag);
  for (int axis = 0; axis < 3; ++axis) append(key, Vector3(def.fluid_frame.rotation.row(axis)));
  append(key, def.fluid_frame.translation);
  return key;
}

// Returns all numbers that models depend on.
Key keyOf(const AttachDef& def, const InverseMass& mass, const RegionFluids& fluids) {
  Key key = keyOf(def);
  append(key, mass.mass);
  append(key, mass.inertia);
  if (!def.follow_regions) return key;
  append(key, mayBlow(def.medium), fluids.media.size());
  for (const FluidKind& kind : fluids.media) append(key, kind);
  for (const SurfaceKind& kind : fluids.surfaces) {
    append(key, kind.below);
    append(key, kind.may_blow, kind.above.has_value());
    if (kind.above) append(key, *kind.above);
  }
  return key;
}

bool isFinite(const Key& key) {
  return std::all_of(key.begin(), key.end(), [](double number) { return std::isfinite(number); });
}

}  // namespace

const MediumModel* FluidModels::find(const FluidKind& kind) const noexcept {
  const auto found = findKind(media, kind);
  return found == media.end() ? nullptr : &*found;
}

int FluidModels::findSurface(const SurfaceKind& kind) const noexcept {
  const auto found = findKind(surfaces, kind);
  return found == surfaces.end() ? -1 : static_cast<int>(found - surfaces.begin());
}

std::shared_ptr<const AttachDef> internDef(AttachDef def, ModelTables& tables) {
  Key key = keyOf(def);
  append(key, def.medium.velocity);
  append(key, def.medium.acceleration);
  append(key, def.flight.tolerance, def.flight.max_substeps);
  append(key, def.holds.are_open, def.holds.atmosphere, def.holds.sloshing_damping);
  key.insert(key.end(), def.holds.water.begin(), def.holds.water.end());
  const auto make = [&] { return std::make_shared<const AttachDef>(def); };
  const bool is_shared =
      def.name.empty() && !def.flow.isOfOneBody() && !def.flight.own_flight && isFinite(key);
  return is_shared ? tables.defs.get(def.fluid_body, key, make) : make();
}

std::shared_ptr<const FluidModels> makeFluidModels(const AttachDef& def, const InverseMass& mass,
                                                   const RegionFluids& fluids,
                                                   ModelTables& tables) {
  checkMedium(*def.fluid_body, def.medium);
  const auto make = [&] {
    return std::make_shared<const FluidModels>(makeModels(def, mass, fluids));
  };
  const Key key = keyOf(def, mass, fluids);
  const bool is_shared = !def.flow.isOfOneBody() && isFinite(key);
  return is_shared ? tables.models.get(def.fluid_body, key, make) : make();
}

void setMass(FluidModels& models, const AttachDef& def, const InverseMass& mass) {
  models.inverse_mass.mass = -1;
  for (MediumModel& medium : models.media)
    medium = inMedium(def, mass, medium.kind, medium.model.loads);
  for (SurfaceMedia& surface : models.surfaces) {
    SurfaceModel& model = surface.model;
    const auto inFluid = [&](const Medium& medium, const BodyModel& before, HoldContent content) {
      return makeBodyModel(*def.fluid_body, def.fluid_frame, propertiesOf(mass), medium,
                           before.loads, {content, def.added_mass_factor, def.load_factor});
    };
    model.below = inFluid(surface.kind.below.medium(), model.below, HoldContent::kSealed);
    model.above = inFluid(surface.kind.mediumAbove(def.medium), model.above, HoldContent::kFull);
    model.still_axis_B = stillAxisOf(model, propertiesOf(mass));
  }
  models.inverse_mass = mass;
}

}  // namespace ambient
