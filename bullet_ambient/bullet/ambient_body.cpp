#include "bullet_ambient/bullet/ambient_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bullet_ambient/bullet/region_following.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

BodyModel makeModel(const AmbientBody& ambient, const MassProperties& mass,
                    const std::shared_ptr<const SurfaceLoads>& loads) {
  const AttachDef& def = ambient.def;
  return makeBodyModel(*def.fluid_body, def.fluid_frame, mass, ambient.medium, loads);
}

// A double holds no sum of masses of which one is 2^52 times the other.
void checkFluidMass(const FluidBody& shape, const BodyModel& model, double mass) {
  const double of_fluid = std::max(model.displaced_mass, model.largest_mass - mass);
  if (!(of_fluid <= std::ldexp(mass, std::numeric_limits<double>::digits - 1)))
    reject(shape, "mass of the medium that it displaces or moves [kg]", of_fluid,
           "at most 2^52 times its own; are its size and the density in SI units?");
}

// Of the body of another mass; their loads stay.
void rebuildSurfaces(AmbientBody& ambient, const MassProperties& mass) {
  const AttachDef& def = ambient.def;
  for (SurfaceMedia& surface : ambient.surfaces) {
    SurfaceModel& model = surface.model;
    surface.has_stand = false;
    model.below = makeBodyModel(*def.fluid_body, def.fluid_frame, mass, surface.kind.below.medium(),
                                model.below.loads);
    model.above = makeBodyModel(*def.fluid_body, def.fluid_frame, mass, surface.kind.above.medium(),
                                model.above.loads);
  }
}

void buildModel(AmbientBody& ambient, const std::shared_ptr<const SurfaceLoads>& loads) {
  const btRigidBody& body = *ambient.body;
  const Vector3 inverse_inertia = toVector3(body.getInvInertiaDiagLocal());
  const Vector3 inertia = inverse_inertia.cwiseInverse();
  const MassProperties mass{1 / static_cast<double>(body.getInvMass()), inertia.asDiagonal()};
  const BodyModel model = makeModel(ambient, mass, loads);
  checkFluidMass(*ambient.def.fluid_body, model, mass.mass);
  ambient.model = model;
  ambient.is_frozen = false;
  rebuildSurfaces(ambient, mass);
  ambient.basis_B = makeVelocityBasis(ambient.model, inertia);
  ambient.seen_inverse_mass = body.getInvMass();
  ambient.seen_inverse_inertia = body.getInvInertiaDiagLocal();
  ambient.memory = {};
}

}  // namespace

AmbientCounters& AmbientCounters::operator+=(const AmbientCounters& other) {
  substeps += other.substeps;
  load_evaluations += other.load_evaluations;
  faces += other.faces;
  guarded += other.guarded;
  coarse += other.coarse;
  halted += other.halted;
  energy_removed += other.energy_removed;
  rows += other.rows;
  joint_rows += other.joint_rows;
  rejected += other.rejected;
  regions_asked += other.regions_asked;
  medium_changes += other.medium_changes;
  too_long += other.too_long;
  return *this;
}

RigidState readState(const btRigidBody& body) {
  RigidState state;
  state.orientation = toQuaternion(body.getWorldTransform().getRotation());
  state.position = toVector3(body.getWorldTransform().getOrigin());
  const Quaternion to_body = state.orientation.conjugate();
  state.twist.angular = to_body * toVector3(body.getAngularVelocity());
  state.twist.linear = to_body * toVector3(body.getLinearVelocity());
  return state;
}

AxisFactors axisFactors(const btRigidBody& body) {
  return {toVector3(body.getAngularFactor()), toVector3(body.getLinearFactor())};
}

Surroundings readSurroundings(const AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  Surroundings s;
  s.gravity = toVector3(body.getGravity());
  s.applied = {toVector3(body.getTotalTorque()), toVector3(body.getTotalForce())};
  s.ambient_velocity = ambient.medium.velocity;
  s.ambient_acceleration = ambient.medium.acceleration;
  return s;
}

void rebuildModel(AmbientBody& ambient) { buildModel(ambient, ambient.model.loads); }

bool isModelStale(const AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  return body.getInvMass() != ambient.seen_inverse_mass ||
         !(body.getInvInertiaDiagLocal() == ambient.seen_inverse_inertia);
}

void refreshModel(AmbientBody& ambient, const FluidRegions& regions, LoadTables& tables) {
  AmbientBody fresh = ambient;
  fresh.media = {makeOwnLoads(ambient.def, tables)};
  fresh.surfaces.clear();
  learnFluids(fresh, makeKnownFluids(ambient.def, regions.fluids(), tables));
  fresh.medium = ambient.def.medium;
  fresh.place = {};
  fresh.encounter = {};
  const auto& loads = fresh.media.front().loads;
  if (ambient.body->getInvMass() > 0) {
    buildModel(fresh, loads);
  } else {
    fresh.model = makeModel(fresh, {1, Matrix3::Identity()}, loads);
    fresh.memory = {};
    markStale(fresh);
  }
  ambient = std::move(fresh);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
