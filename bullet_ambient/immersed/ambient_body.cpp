#include "bullet_ambient/immersed/ambient_body.h"

#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN

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

void followWake(AmbientBody& ambient, double duration) noexcept {
  const auto& loads = loadsOn(ambient);
  const double by_wake = loads ? loads->wakeShare() : 0;
  AMBIENT_ASSERT(by_wake >= 0 && by_wake <= 1);
  ambient.load_share = 1;
  if (by_wake > 0) {
    const btRigidBody& body = *ambient.body;
    const Twist motion{toVector3(body.getAngularVelocity()),
                       toVector3(body.getLinearVelocity()) - ambient.medium.velocity};
    const FluidBody& shape = *ambient.def->fluid_body;
    const double developed =
        developWake({motion, shape.area, shape.volume, duration}, ambient.wake);
    ambient.load_share = 1 - by_wake + by_wake * developed;
  }
}

void keepName(const std::string& name, AmbientBody& ambient) {
  if (name.empty() || !ambient.def->name.empty()) return;
  AttachDef named = *ambient.def;
  named.name = name;
  ambient.def = std::make_shared<const AttachDef>(std::move(named));
}

void setModels(AmbientBody& ambient, std::shared_ptr<const FluidModels> models) {
  if (models == ambient.models) return;
  if (ambient.encounter.media >= 0) {
    const auto met = static_cast<std::size_t>(ambient.encounter.media);
    ambient.encounter.media = models->findSurface(ambient.models->surfaces[met].kind);
  }
  ambient.models = std::move(models);
  ambient.own_models = nullptr;
  const FluidModels& known = *ambient.models;
  // A medium that is not known any more serves until the next step.
  if (const MediumModel* found = known.find(FluidKind(ambient.medium)))
    ambient.in_medium = {ambient.models, found};
  if (known.surfaces.empty()) {
    ambient.last_stand = nullptr;
  } else if (ambient.last_stand) {
    ambient.last_stand->is_valid = false;
  } else {
    ambient.last_stand = std::make_unique<LastStand>();
  }
}

bool isModelStale(const AmbientBody& ambient) {
  return !(ambient.models->inverse_mass == inverseMassOf(*ambient.body));
}

void rebuildModels(AmbientBody& ambient) {
  if (!ambient.own_models) {
    auto own = std::make_shared<FluidModels>(*ambient.models);
    setModels(ambient, own);
    ambient.own_models = std::move(own);
  }
  setMass(*ambient.own_models, *ambient.def, inverseMassOf(*ambient.body));
  if (ambient.last_stand) ambient.last_stand->is_valid = false;
  ambient.memory = {};
}

AMBIENT_END
