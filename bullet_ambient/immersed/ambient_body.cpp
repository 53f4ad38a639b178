#include "bullet_ambient/immersed/ambient_body.h"

#include <algorithm>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

// True if loads of some fluid depend on the wake of the body.
bool dependOnWake(const FluidModels& models) {
  const auto depends = [](const auto& loads) { return loads && loads->wakeShare() > 0; };
  return std::any_of(models.media.begin(), models.media.end(),
                     [&](const MediumModel& medium) { return depends(medium.model.loads); }) ||
         std::any_of(
             models.surfaces.begin(), models.surfaces.end(),
             [&](const SurfaceMedia& media) { return depends(media.model.loads_below.loads); });
}

}  // namespace

Wrench pushByFlow(const AmbientBody& ambient, const Quaternion& q) noexcept {
  if (!hasFlowAlong(ambient)) return {};
  const FlowAlongBody& flow = *ambient.flow_along;
  const double mass = 1 / ambient.models->inverse_mass.mass;
  const Wrench push_B = flow.at_rest_B + flow.push_B;
  return Wrench{q * push_B.torque, q * push_B.force + mass * flow.lean_W} + flow.wrenchAtSides() +
         flow.layers_W;
}

void addFlowAlong(const AmbientBody& ambient, const Quaternion& orientation,
                  Surroundings& surroundings) noexcept {
  if (!hasFlowAlong(ambient)) return;
  const FlowAlongBody& flow = *ambient.flow_along;
  surroundings.flow = &flow;
  surroundings.gravity += flow.lean_W;
  surroundings.applied += pushByFlow(ambient, orientation);
}

void followWake(AmbientBody& ambient, const Twist& twist_W, double duration) noexcept {
  const auto& loads = loadsOn(ambient);
  const double by_wake = loads ? loads->wakeShare() : 0;
  AMBIENT_ASSERT(by_wake >= 0 && by_wake <= 1);
  const double factor = ambient.def->load_factor;
  ambient.load_scale = factor;
  if (by_wake > 0 && ambient.wake) {
    const Twist motion{twist_W.angular, twist_W.linear - ambient.medium.velocity};
    const FluidBody& shape = *ambient.def->fluid_body;
    const double developed = developWake(motion, shape.area, shape.volume, duration, *ambient.wake);
    ambient.load_scale = factor * (1 - by_wake + by_wake * developed);
  }
}

void setHandle(AmbientBody& ambient, const AmbientBody* before) {
  ambient.handle = before ? before->handle : std::make_shared<AmbientBody*>();
  *ambient.handle = &ambient;
  if (!before) return;
  ambient.sensor = before->sensor;
  const std::string& name = before->def->name;  // no state has it
  if (name.empty() || !ambient.def->name.empty()) return;
  AttachDef named = *ambient.def;
  named.name = name;
  ambient.def = std::make_shared<const AttachDef>(std::move(named));
}

void forgetFlight(AmbientBody& ambient) noexcept {
  if (auto* last = std::get_if<LastFlight>(&ambient.outcome.motion)) last->memory = {};
  if (auto* rows = std::get_if<RowMotion>(&ambient.outcome.motion)) rows->load_W = {};
}

void forgetWake(AmbientBody& ambient) noexcept {
  if (ambient.wake) *ambient.wake = {};
}

void forgetSurface(AmbientBody& ambient) noexcept {
  if (ambient.vessel)
    std::fill(ambient.vessel->sloshing.now.begin(), ambient.vessel->sloshing.now.end(), Sloshing{});
  if (!ambient.floating) return;
  ambient.floating->waves = {};
  ambient.floating->forgetPlane();
}

void setModels(AmbientBody& ambient, std::shared_ptr<const FluidModels> models) {
  if (models == ambient.models) return;
  if (ambient.surface_media >= 0) {
    const auto met = static_cast<std::size_t>(ambient.surface_media);
    ambient.surface_media = models->findSurface(ambient.models->surfaces[met].kind);
  }
  ambient.models = std::move(models);
  ambient.has_own_models = false;
  const FluidModels& known = *ambient.models;
  // A medium that is not known any more serves until the next step.
  if (const MediumModel* found = known.find(FluidKind(ambient.medium)))
    ambient.in_medium = {ambient.models, found};
  if (known.surfaces.empty()) {
    ambient.floating = nullptr;
  } else if (ambient.floating) {
    ambient.floating->is_valid = false;
  } else {
    ambient.floating = std::make_unique<FloatingState>();
  }
  if (!dependOnWake(known)) {
    ambient.wake = nullptr;
  } else if (!ambient.wake) {
    ambient.wake = std::make_unique<Wake>();
  }
}

namespace {

// Makes room for waves at the edges of one more opening.
void addRises(std::size_t edges, VesselState& vessel) {
  vessel.rises.emplace_back(edges);
  vessel.waves_inside.rises.emplace_back(edges);
  vessel.waves_inside.reaches.push_back(0);
}

}  // namespace

void setHolds(AmbientBody& ambient) {
  const AttachDef& def = *ambient.def;
  const std::vector<Hold>& holds = def.fluid_body->holds;
  if (ambient.vessel && ambient.vessel->shape == def.fluid_body) return;
  if (ambient.vessel && ambient.floating) {
    ambient.floating->flotation.inside_F = nullptr;  // goes with the vessel
    ambient.floating->is_valid = false;
  }
  ambient.vessel = nullptr;
  if (holds.empty()) return;
  ambient.vessel = std::make_unique<VesselState>();
  ambient.vessel->shape = def.fluid_body;
  ambient.vessel->holds.resize(holds.size());
  ambient.vessel->sloshing.resize(holds.size());
  ambient.vessel->waves_inside.energy.resize(holds.size());
  ambient.vessel->waves_inside.lost.resize(holds.size());
  for (const Hold& hold : holds)
    for (const HoldOpening& opening : hold.openings) {
      ambient.vessel->changes.is_shut.push_back(0);
      addRises(OpeningShape(opening).edges().size(), *ambient.vessel);
    }
  ambient.vessel->is_known = !def.holds.water.empty();
  for (std::size_t i = 0; i < def.holds.water.size(); ++i)
    ambient.vessel->holds[i].volume = def.holds.water[i];
}

void addHole(const AddedHole& hole, VesselState& vessel) {
  vessel.changes.add(hole);
  addRises(vessel.changes.added.back().shape.edges().size(), vessel);
}

void rebuildModels(AmbientBody& ambient, const InverseMass& mass) {
  if (!ambient.has_own_models) {
    setModels(ambient, std::make_shared<FluidModels>(*ambient.models));
    ambient.has_own_models = true;
  }
  // Made above, and not const there.
  FluidModels& own = const_cast<FluidModels&>(*ambient.models);
  setMass(own, *ambient.def, mass);
  if (ambient.floating) ambient.floating->is_valid = false;
  forgetFlight(ambient);
}

}  // namespace ambient
