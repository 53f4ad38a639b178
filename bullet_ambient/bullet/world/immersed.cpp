#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/wrench_sensor.h"

AMBIENT_BEGIN
namespace {

// Returns the present pose of a body or link, and its motion; of a link that at the last
// computeLinkPoses().
MotionView presentMotion(const AmbientBody& ambient, const AmbientBodies& bodies) {
  if (ambient.body) return motionOf(*ambient.body);
  AmbientLink& link = bodies.trees.linkOf(ambient);
  readLinkPose(*ambient.multi_body, link);
  return link.now;
}

// Returns the present pose and velocity.
MotionView presentVelocity(const AmbientBody& ambient, const AmbientBodies& bodies) {
  if (!ambient.body) computeLinkPosesNow(bodies.trees.treeOf(ambient));
  return presentMotion(ambient, bodies);
}

void replaceDef(AmbientBody& ambient, AttachDef def, AmbientBodies& bodies) {
  const auto before = std::exchange(ambient.def, internDef(std::move(def), bodies.load_tables));
  const InverseMass mass =
      ambient.body ? inverseMassOf(*ambient.body) : bodies.trees.linkOf(ambient).mass;
  try {
    refresh(ambient, mass, presentMotion(ambient, bodies), bodies);
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
bool changeMedium(AmbientBody& ambient, const Medium& medium, AmbientBodies& bodies) {
  checkMedium(*ambient.def->fluid_body, medium);
  const Medium before = ambient.def->medium;
  AttachDef def = *ambient.def;
  def.medium = medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity ||
      (mayBlow(medium) != mayBlow(before) && isOwnAboveSurfaces(ambient))) {
    replaceDef(ambient, std::move(def), bodies);
    return true;
  }
  if (medium.velocity == before.velocity && medium.acceleration == before.acceleration)
    return false;
  ambient.def = std::make_shared<const AttachDef>(std::move(def));
  if (ambient.location.region == RegionId::kNone) {
    ambient.medium = medium;
    ambient.flow.change.setZero();
  }
  return true;
}

void changeFluidBody(AmbientBody& ambient, std::shared_ptr<const FluidBody> fluid_body,
                     const std::optional<FrameOffset>& fluid_frame, AmbientBodies& bodies) {
  if (!fluid_body) throw std::invalid_argument("setFluidBody: the fluid body is null");
  AttachDef def = *ambient.def;
  def.fluid_body = std::move(fluid_body);
  if (fluid_frame) def.fluid_frame = *fluid_frame;
  def.holds.water.clear();  // of other holds
  replaceDef(ambient, std::move(def), bodies);
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

// Returns the number of an opening among all of the body: those of the shape, then those added;
// -1: there is none.
int findOpening(const VesselState& vessel, int hold, int opening) {
  int of_shapes = 0, of_hold = 0, found = -1;
  for (int i = 0; i < static_cast<int>(vessel.shape->holds.size()); ++i) {
    const int count =
        static_cast<int>(vessel.shape->holds[static_cast<std::size_t>(i)].openings.size());
    if (i == hold && opening < count) found = of_shapes + opening;
    if (i == hold) of_hold = count;
    of_shapes += count;
  }
  for (std::size_t i = 0; i < vessel.changes.holes.size(); ++i)
    if (vessel.changes.holes[i].hold == hold && of_hold++ == opening)
      found = of_shapes + static_cast<int>(i);
  return opening < 0 ? -1 : found;
}

// Whether a place is in the box around a body, or by its rounding beside it.
bool isAtBody(const FluidBody& body, const Vector3& place) {
  constexpr double kBeside = 0.01;  // of the diagonal
  const std::vector<double>& v = body.surface.vertices;
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
    low = low.cwiseMin(Vector3(v[i], v[i + 1], v[i + 2]));
    high = high.cwiseMax(Vector3(v[i], v[i + 1], v[i + 2]));
  }
  const double beside = kBeside * (high - low).norm();
  return ((place - low).array() >= -beside).all() && ((high - place).array() >= -beside).all();
}

void checkHole(const AttachDef& def, const Vector3& place, const Vector3& normal, double area) {
  const std::string who = "addOpening: " + nameOf(def) + " would have a hole ";
  if (!(area > 0) || !std::isfinite(area))
    throw std::invalid_argument(who + "of " + std::to_string(area) +
                                " m^2, which must be positive and finite");
  if (area > def.fluid_body->area)
    throw std::invalid_argument(who + "of " + std::to_string(area) +
                                " m^2, more than the area of its fluid body");
  if (!normal.allFinite() || normal.isZero(0))
    throw std::invalid_argument(who + "without a direction out of the hold");
  if (!place.allFinite() || !isAtBody(*def.fluid_body, place))
    throw std::invalid_argument(who + "at (" + std::to_string(place.x()) + ", " +
                                std::to_string(place.y()) + ", " + std::to_string(place.z()) +
                                ") m in the frame of its fluid body, which is not at the body");
}

}  // namespace

Immersed::Immersed(AmbientBodies& bodies, const AmbientBody& ambient)
    : bodies_(bodies.weak_from_this()), handle_(ambient.handle) {}

Immersed::Access Immersed::lock() const noexcept {
  const auto handle = handle_.lock();
  return {bodies_.lock(), handle ? *handle : nullptr};
}

Immersed::Access Immersed::require(const char* function) const {
  Access access = lock();
  if (access.ambient) return access;
  const bool is_closed = !access.bodies || access.bodies->is_closed;
  throw std::logic_error(std::string(function) +
                         (is_closed ? ": the Fluid of this Immersed was destroyed"
                                    : ": this Immersed was removed from its Fluid"));
}

Immersed::Access Immersed::requireChangeable(const char* function) const {
  Access access = require(function);
  access.bodies->requireChangeable(function);
  return access;
}

bool Immersed::isValid() const noexcept { return lock().ambient; }

void Immersed::setMedium(const Medium& medium) const {
  const Access access = requireChangeable("setMedium");
  if (changeMedium(*access.ambient, medium, *access.bodies)) wake(*access.ambient);
}

void Immersed::setFluidBody(std::shared_ptr<const FluidBody> fluid_body,
                            const std::optional<FrameOffset>& fluid_frame) const {
  const Access access = requireChangeable("setFluidBody");
  changeFluidBody(*access.ambient, std::move(fluid_body), fluid_frame, *access.bodies);
  wake(*access.ambient);
}

void Immersed::setFactors(double added_mass, double loads) const {
  const Access access = requireChangeable("setFactors");
  AttachDef def = *access.ambient->def;
  if (added_mass == def.added_mass_factor && loads == def.load_factor) return;
  def.added_mass_factor = added_mass;
  def.load_factor = loads;
  checkDef("setFactors: " + nameOf(def), def);
  replaceDef(*access.ambient, std::move(def), *access.bodies);
  wake(*access.ambient);
}

Medium Immersed::medium() const {
  const Access access = require("medium");
  Medium medium = access.ambient->medium;
  medium.velocity += access.ambient->flow.change;
  return medium;
}

std::shared_ptr<const FluidBody> Immersed::fluidBody() const {
  return require("fluidBody").ambient->def->fluid_body;
}

RegionId Immersed::region() const { return require("region").ambient->location.region; }

Matrix6 Immersed::inertia() const {
  const Access access = require("inertia");
  return modelNow(*access.ambient, presentMotion(*access.ambient, *access.bodies)).inertia;
}

double Immersed::kineticEnergy() const {
  const Access access = require("kineticEnergy");
  return kineticEnergyNow(*access.ambient, presentVelocity(*access.ambient, *access.bodies));
}

AmbientCounters Immersed::counters() const { return require("counters").ambient->counters; }

void Immersed::readWrench(bool is_read) const {
  const Access access = requireChangeable("readWrench");
  AmbientBody& ambient = *access.ambient;
  if (is_read == (ambient.sensor != nullptr)) return;
  ambient.sensor = is_read ? std::make_shared<WrenchSensor>() : nullptr;
  if (!is_read) return;
  ambient.sensor->wrench = wrenchNow(ambient, presentVelocity(*access.ambient, *access.bodies));
}

FluidWrench Immersed::wrench() const {
  const Access access = require("wrench");
  const AmbientBody& ambient = *access.ambient;
  if (!ambient.sensor)
    throw std::logic_error("wrench: it is not read; call readWrench(true) before a step");
  return ambient.isInFluid() ? ambient.sensor->wrench : FluidWrench{};
}

WetState Immersed::wet() const {
  const Access access = require("wet");
  return wetStateOf(*access.ambient, presentMotion(*access.ambient, *access.bodies),
                    access.bodies->regions);
}

std::vector<HoldWater> Immersed::holds() const {
  const Access access = require("holds");
  return holdsOf(*access.ambient, presentMotion(*access.ambient, *access.bodies));
}

void Immersed::setWater(int hold, double volume) const {
  const Access access = requireChangeable("setWater");
  AmbientBody& ambient = *access.ambient;
  HoldState& state = holdOf("setWater", ambient, hold);
  checkWater("setWater: " + nameOf(*ambient.def), hold, volume,
             ambient.vessel->shape->holds[static_cast<std::size_t>(hold)].volume);
  state.volume = volume;
  state.is_sealed = false;
  ambient.vessel->sloshing.now[static_cast<std::size_t>(hold)] = {};
  ambient.vessel->is_known = true;
  if (ambient.floating) ambient.floating->is_valid = false;
  wake(*access.ambient);
}

void Immersed::pump(int hold, double rate) const {
  const Access access = requireChangeable("pump");
  HoldState& state = holdOf("pump", *access.ambient, hold);
  if (!std::isfinite(rate))
    throw std::invalid_argument("pump: the rate [m^3/s] is " + std::to_string(rate) +
                                ", must be finite");
  state.pump = rate;
  wake(*access.ambient);
}

void Immersed::setOpening(int hold, int opening, bool is_open) const {
  const Access access = requireChangeable("setOpening");
  const AmbientBody& ambient = *access.ambient;
  holdOf("setOpening", ambient, hold);
  const int found = findOpening(*ambient.vessel, hold, opening);
  if (found < 0)
    throw std::invalid_argument("setOpening: hold " + std::to_string(hold) + " of " +
                                nameOf(*ambient.def) + " has no opening with the number " +
                                std::to_string(opening));
  ambient.vessel->changes.is_shut[static_cast<std::size_t>(found)] = !is_open;
  wake(*access.ambient);
}

int Immersed::addOpening(int hold, const Vector3& place, const Vector3& normal, double area) const {
  const Access access = requireChangeable("addOpening");
  const AmbientBody& ambient = *access.ambient;
  holdOf("addOpening", ambient, hold);
  checkHole(*ambient.def, place, normal, area);
  VesselState& vessel = *ambient.vessel;
  AddedHole hole;
  hole.hold = hold;
  hole.place = place;
  hole.normal = normal.normalized();
  hole.area = area;
  addHole(hole, vessel);
  wake(*access.ambient);
  const auto& holes = vessel.changes.holes;
  const auto added = std::count_if(holes.begin(), holes.end(),
                                   [&](const AddedHole& other) { return other.hold == hold; });
  const auto own = vessel.shape->holds[static_cast<std::size_t>(hold)].openings.size();
  return static_cast<int>(own) + static_cast<int>(added) - 1;
}

bool Immersed::remove() const {
  const Access access = lock();
  if (!access.ambient) return false;
  access.bodies->requireChangeable("remove");
  if (access.ambient->body) return access.bodies->erase(*access.ambient->body);
  AmbientTrees& trees = access.bodies->trees;
  return trees.erase(*access.ambient->multi_body, trees.linkOf(*access.ambient).link);
}

AMBIENT_END
