#include "bullet_ambient/immersed/ambient_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
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

// Rebuilds the models at surfaces for another mass; their loads stay.
void rebuildSurfaces(AmbientBody& ambient, const MassProperties& mass) {
  const AttachDef& def = ambient.def;
  for (SurfaceMedia& surface : ambient.surfaces) {
    SurfaceModel& model = surface.model;
    surface.has_stand = false;
    model.below = makeBodyModel(*def.fluid_body, def.fluid_frame, mass, surface.kind.below.medium(),
                                model.below.loads);
    model.above = makeBodyModel(*def.fluid_body, def.fluid_frame, mass,
                                surface.kind.mediumAbove(def.medium), model.above.loads);
  }
}

}  // namespace

RigidState readState(const btRigidBody& body) {
  RigidState state;
  state.orientation = toQuaternion(body.getWorldTransform().getRotation());
  state.position = toVector3(body.getWorldTransform().getOrigin());
  state.twist = turned(state.orientation.conjugate(), velocityOf(body));
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

void followWake(AmbientBody& ambient, double duration) noexcept {
  const auto& loads = loadsOn(ambient);
  const double by_wake = loads ? loads->wakeShare() : 0;
  AMBIENT_ASSERT(by_wake >= 0 && by_wake <= 1);
  ambient.load_share = 1;
  if (by_wake > 0) {
    const btRigidBody& body = *ambient.body;
    const Twist motion{toVector3(body.getAngularVelocity()),
                       toVector3(body.getLinearVelocity()) - ambient.medium.velocity};
    const FluidBody& shape = *ambient.def.fluid_body;
    const double developed =
        developWake({motion, shape.area, shape.volume, duration}, ambient.wake);
    ambient.load_share = 1 - by_wake + by_wake * developed;
  }
  ambient.model.load_share = ambient.load_share;
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

void buildUnitModel(AmbientBody& ambient, const std::shared_ptr<const SurfaceLoads>& loads) {
  ambient.model = makeModel(ambient, {1, Matrix3::Identity()}, loads);
  ambient.memory = {};
  markStale(ambient);
}

bool isModelStale(const AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  return body.getInvMass() != ambient.seen_inverse_mass ||
         !(body.getInvInertiaDiagLocal() == ambient.seen_inverse_inertia);
}

AMBIENT_END
