#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_links.h"
#include "bullet_ambient/bullet/links/tree_now.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/fluid_reading.h"

AMBIENT_BEGIN
namespace {

AmbientLink& linkOf(const Member& member) {
  for (const auto& link : member.tree->links)
    if (&link->ambient == member.ambient) return *link;
  AMBIENT_ASSERT(false);
  return *member.tree->links.front();
}

// Returns the present pose of a body or link, and its motion; of a link that at the last
// placeLinks().
MotionView presentMotion(const Member& member) {
  if (!member.tree) return motionOf(*member.ambient->body);
  AmbientLink& link = linkOf(member);
  readLinkPose(*member.tree->multi_body, link);
  return link.now;
}

void replaceDef(const Member& member, AttachDef def, AmbientBodies& bodies) {
  AmbientBody& ambient = *member.ambient;
  const auto before = std::exchange(ambient.def, shareDef(std::move(def), bodies.load_tables));
  const InverseMass mass = member.tree ? linkOf(member).mass : inverseMassOf(*ambient.body);
  try {
    refresh(ambient, mass, presentMotion(member), bodies);
  } catch (...) {
    ambient.def = before;
    throw;
  }
}

// Whether the body's own medium is above surfaces where regions name none: it then has loads by
// wind if that medium moves.
bool isOwnAboveSurfaces(const AmbientBody& ambient) {
  const auto& surfaces = ambient.models->surfaces;
  return std::any_of(surfaces.begin(), surfaces.end(),
                     [](const SurfaceMedia& surface) { return !surface.kind.above; });
}

// Whether the fluid is another one than before.
bool changeMedium(const Member& member, const Medium& medium, AmbientBodies& bodies) {
  AmbientBody& ambient = *member.ambient;
  checkMedium(*ambient.def->fluid_body, medium);
  const Medium before = ambient.def->medium;
  AttachDef def = *ambient.def;
  def.medium = medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity ||
      (mayBlow(medium) != mayBlow(before) && isOwnAboveSurfaces(ambient))) {
    replaceDef(member, std::move(def), bodies);
    return true;
  }
  if (medium.velocity == before.velocity && medium.acceleration == before.acceleration)
    return false;
  ambient.def = std::make_shared<const AttachDef>(std::move(def));
  if (ambient.place.region == RegionId::kNone) {
    ambient.medium = medium;
    ambient.flow.change.setZero();
  }
  return true;
}

void changeFluidBody(const Member& member, std::shared_ptr<const FluidBody> fluid_body,
                     const FrameOffset& fluid_frame, AmbientBodies& bodies) {
  if (!fluid_body) throw std::invalid_argument("setFluidBody: the fluid body is null");
  AttachDef def = *member.ambient->def;
  def.fluid_body = std::move(fluid_body);
  def.fluid_frame = fluid_frame;
  def.holds.water.clear();  // of other holds
  replaceDef(member, std::move(def), bodies);
}

// Returns the state of a hold, after a check that there is such a one.
HoldState& holdOf(const char* function, const AmbientBody& ambient, int hold) {
  const std::size_t count = ambient.vessel ? ambient.vessel->holds.size() : 0;
  if (hold < 0 || static_cast<std::size_t>(hold) >= count)
    throw std::invalid_argument(std::string(function) + ": " + nameOf(*ambient.def) + " has " +
                                std::to_string(count) + " holds, and none has the number " +
                                std::to_string(hold));
  return ambient.vessel->holds[static_cast<std::size_t>(hold)];
}

void wakeUp(const Member& member) {
  if (member.tree) {
    wake(*member.tree->multi_body);
  } else {
    member.ambient->body->activate();
  }
}

}  // namespace

Immersed::Immersed(AmbientBodies& bodies, const AmbientBody& ambient)
    : bodies_(bodies.weak_from_this()), id_(bodies.slots.nameOf(ambient)) {}

Immersed::Held Immersed::hold() const noexcept {
  Held held{bodies_.lock(), {}};
  if (held.bodies) held.member = held.bodies->slots.find(id_);
  return held;
}

Immersed::Held Immersed::require(const char* function) const {
  Held held = hold();
  if (held.member.ambient) return held;
  const bool is_closed = !held.bodies || held.bodies->is_closed;
  throw std::logic_error(std::string(function) +
                         (is_closed ? ": the Fluid or the world of this Immersed was destroyed"
                                    : ": this Immersed was removed from its Fluid"));
}

bool Immersed::isValid() const noexcept { return hold().member.ambient; }

void Immersed::setMedium(const Medium& medium) const {
  const Held held = require("setMedium");
  held.bodies->requireChangeable("setMedium");
  if (changeMedium(held.member, medium, *held.bodies)) wakeUp(held.member);
}

void Immersed::setFluidBody(std::shared_ptr<const FluidBody> fluid_body) const {
  setFluidBody(std::move(fluid_body), require("setFluidBody").member.ambient->def->fluid_frame);
}

void Immersed::setFluidBody(std::shared_ptr<const FluidBody> fluid_body,
                            const FrameOffset& fluid_frame) const {
  const Held held = require("setFluidBody");
  held.bodies->requireChangeable("setFluidBody");
  changeFluidBody(held.member, std::move(fluid_body), fluid_frame, *held.bodies);
  wakeUp(held.member);
}

Medium Immersed::medium() const {
  const Held held = require("medium");
  Medium medium = held.member.ambient->medium;
  medium.velocity += held.member.ambient->flow.change;
  return medium;
}

std::shared_ptr<const FluidBody> Immersed::fluidBody() const {
  return require("fluidBody").member.ambient->def->fluid_body;
}

RegionId Immersed::region() const { return require("region").member.ambient->place.region; }

Matrix6 Immersed::inertia() const {
  const Held held = require("inertia");
  return modelNow(*held.member.ambient, presentMotion(held.member)).inertia;
}

double Immersed::kineticEnergy() const {
  const Held held = require("kineticEnergy");
  if (held.member.tree) placeLinksNow(*held.member.tree);
  return kineticEnergyNow(*held.member.ambient, presentMotion(held.member));
}

AmbientCounters Immersed::counters() const { return require("counters").member.ambient->counters; }

void Immersed::readWrench(bool is_read) const {
  const Held held = require("readWrench");
  held.bodies->requireChangeable("readWrench");
  AmbientBody& ambient = *held.member.ambient;
  if (is_read == (ambient.reading != nullptr)) return;
  ambient.reading = is_read ? std::make_shared<FluidReading>() : nullptr;
  if (!is_read) return;
  if (held.member.tree) placeLinksNow(*held.member.tree);
  ambient.reading->wrench = wrenchNow(ambient, presentMotion(held.member));
}

FluidWrench Immersed::wrench() const {
  const Held held = require("wrench");
  const AmbientBody& ambient = *held.member.ambient;
  if (!ambient.reading)
    throw std::logic_error("wrench: it is not read; call readWrench(true) before a step");
  return ambient.isInFluid() ? ambient.reading->wrench : FluidWrench{};
}

WetState Immersed::wet() const {
  const Held held = require("wet");
  return wetStateOf(*held.member.ambient, presentMotion(held.member), held.bodies->regions);
}

std::vector<HoldWater> Immersed::holds() const {
  const Held held = require("holds");
  return holdsOf(*held.member.ambient, presentMotion(held.member));
}

void Immersed::setWater(int hold, double volume) const {
  const Held held = require("setWater");
  held.bodies->requireChangeable("setWater");
  AmbientBody& ambient = *held.member.ambient;
  HoldState& state = holdOf("setWater", ambient, hold);
  checkWater("setWater: " + nameOf(*ambient.def), hold, volume,
             ambient.vessel->shape->holds[static_cast<std::size_t>(hold)].volume);
  state.volume = volume;
  state.is_sealed = false;
  ambient.vessel->is_known = true;
  if (ambient.floating) ambient.floating->is_valid = false;
  wakeUp(held.member);
}

void Immersed::pump(int hold, double rate) const {
  const Held held = require("pump");
  held.bodies->requireChangeable("pump");
  HoldState& state = holdOf("pump", *held.member.ambient, hold);
  if (!std::isfinite(rate))
    throw std::invalid_argument("pump: the rate [m^3/s] is " + std::to_string(rate) +
                                ", must be finite");
  state.pump = rate;
  wakeUp(held.member);
}

void Immersed::applyImpulse(const Wrench& impulse) const {
  const Held held = require("applyImpulse");
  if (held.member.tree) {
    applyImpulseToLink(held.bodies->trees, *held.member.tree, linkOf(held.member).link, impulse);
  } else {
    applyImpulseToBody(*held.member.ambient, impulse);
  }
  wakeUp(held.member);
}

bool Immersed::remove() const {
  const Held held = hold();
  if (!held.member.ambient) return false;
  held.bodies->requireChangeable("remove");
  if (!held.member.tree) return held.bodies->erase(*held.member.ambient->body);
  return held.bodies->trees.erase(*held.member.tree->multi_body, linkOf(held.member).link);
}

AMBIENT_END
