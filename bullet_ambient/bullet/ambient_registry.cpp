#include "bullet_ambient/bullet/ambient_registry.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/region_following.h"
#include "bullet_ambient/bullet/world_tie.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

void checkFlight(const std::string& who, const FlightSettings& flight) {
  if (!(flight.tolerance > 0) || !std::isfinite(flight.tolerance)) {
    throw std::invalid_argument(who + " has a flight tolerance of " +
                                std::to_string(flight.tolerance) +
                                ", which must be positive and finite");
  }
  if (flight.max_substeps < 0) {
    throw std::invalid_argument(who + " has max_substeps of " +
                                std::to_string(flight.max_substeps) +
                                ", which must be zero or positive");
  }
}

// Of what can be computed, but hardly was meant.
void sayOddities(const AmbientBody& ambient, Complaints& complaints) {
  constexpr double kRounding = 1e-3;
  const FluidBody& shape = *ambient.def.fluid_body;
  const std::string who = "bullet_ambient: body with fluid body '" + shape.name + "' ";
  const Vector3 moments = toVector3(ambient.body->getInvInertiaDiagLocal()).cwiseInverse();
  const double largest = moments.maxCoeff(), others = moments.sum() - largest;
  if (largest > (1 + kRounding) * others) {
    const std::string text = who + "has a principal moment of inertia of " +
                             std::to_string(largest) + " kg m^2, but no rigid body has one above " +
                             std::to_string(others) + " kg m^2, the sum of the other two";
    complaints.say(Complaint::kInertia, text.c_str());
  }
  if (ambient.isInFluid() && !ambient.model.loads && !(shape.volume > 0) &&
      shape.added_mass.isZero(0)) {
    const std::string text =
        who + "feels no fluid: without faces, volume and added mass its shape is empty";
    complaints.say(Complaint::kEmpty, text.c_str());
  }
}

// Loads and model, in the medium where the body is now.
void refresh(AmbientBody& ambient, AmbientBodies& bodies) {
  refreshModel(ambient, bodies.regions, bodies.load_tables);
  followRegions(ambient, bodies.regions, 0, bodies.complaints);
  if (ambient.body->getInvMass() > 0 && isModelStale(ambient)) rebuildModel(ambient);
}

void replaceDef(AmbientBody& ambient, AttachDef def, AmbientBodies& bodies) {
  std::swap(ambient.def, def);
  try {
    refresh(ambient, bodies);
  } catch (...) {
    std::swap(ambient.def, def);
    throw;
  }
  ambient.body->activate();
}

}  // namespace

AmbientBodies& bodiesOf(const AmbientRegistry& registry) { return *registry.bodies_; }

AmbientRegistry::AmbientRegistry() : bodies_(std::make_unique<AmbientBodies>()) {
  setReport([](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); });
}

AmbientRegistry::~AmbientRegistry() = default;

void AmbientRegistry::attach(const btDynamicsWorld& world, btRigidBody& body, AttachDef def) {
  checkWorldKind("attach", world);
  attach(body, std::move(def));
}

void AmbientRegistry::attach(btRigidBody& body, AttachDef def) {
  if (!def.fluid_body) {
    throw std::invalid_argument("attach: the fluid body is null; load one with loadFluidBody()");
  }
  const std::string who = "attach: body with fluid body '" + def.fluid_body->name + "'";
  if (body.isStaticOrKinematicObject()) {
    throw std::invalid_argument(
        who + " is static or kinematic (mass 0); only dynamic bodies feel a fluid");
  }
  if (!(body.getInvMass() > 0)) {
    throw std::invalid_argument(who + " has an inverse mass of " +
                                std::to_string(body.getInvMass()) +
                                "; must be positive and finite");
  }
  if (isAttached(body)) {
    throw std::invalid_argument(who + " is attached already; use setMedium() or detach it first");
  }
  checkFlight(who, def.flight);
  auto ambient = std::make_unique<AmbientBody>();
  ambient->body = &body;
  ambient->def = std::move(def);
  refresh(*ambient, *bodies_);
  if (ambient->isInFluid()) body.activate();
  sayOddities(*ambient, bodies_->complaints);
  bodies_->insert(std::move(ambient));
}

bool AmbientRegistry::detach(const btRigidBody& body) { return bodies_->erase(body); }

void AmbientRegistry::clear() { bodies_->clear(); }

bool AmbientRegistry::isAttached(const btRigidBody& body) const { return bodies_->find(&body); }

void AmbientRegistry::setMedium(const btRigidBody& body, const Medium& medium) {
  AmbientBody& ambient = bodies_->require(body);
  checkMedium(*ambient.def.fluid_body, medium);
  const Medium before = ambient.def.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    AttachDef def = ambient.def;
    def.medium = medium;
    replaceDef(ambient, std::move(def), *bodies_);
  } else if (medium.velocity != before.velocity || medium.acceleration != before.acceleration) {
    ambient.def.medium = medium;
    if (ambient.place.region == RegionId::kNone) ambient.medium = medium;
    ambient.body->activate();
  }
}

void AmbientRegistry::setFluidBody(const btRigidBody& body,
                                   std::shared_ptr<const FluidBody> fluid_body) {
  setFluidBody(body, std::move(fluid_body), bodies_->require(body).def.fluid_frame);
}

void AmbientRegistry::setFluidBody(const btRigidBody& body,
                                   std::shared_ptr<const FluidBody> fluid_body,
                                   const FrameOffset& fluid_frame) {
  AmbientBody& ambient = bodies_->require(body);
  if (!fluid_body) throw std::invalid_argument("setFluidBody: the fluid body is null");
  AttachDef def = ambient.def;
  def.fluid_body = std::move(fluid_body);
  def.fluid_frame = fluid_frame;
  replaceDef(ambient, std::move(def), *bodies_);
}

const Medium& AmbientRegistry::medium(const btRigidBody& body) const {
  return bodies_->require(body).medium;
}

// Changes a copy and makes all loads first: what throws changes nothing.
template <class Change>
auto AmbientRegistry::changeRegions(const Change& change) {
  FluidRegions regions = bodies_->regions;
  const auto result = change(regions);
  std::vector<std::vector<MediumLoads>> media;
  std::vector<std::vector<SurfaceMedia>> surfaces;
  LoadTables& tables = bodies_->load_tables;
  for (const auto& ambient : bodies_->all()) {
    media.push_back(makeMediumLoads(ambient->def, regions, tables, ambient->media));
    surfaces.push_back(makeSurfaceMedia(ambient->def, regions, tables, ambient->surfaces));
  }
  bodies_->regions = std::move(regions);
  std::size_t next = 0;
  for (const auto& ambient : bodies_->all()) {
    ambient->media = std::move(media[next]);
    replaceSurfaces(*ambient, std::move(surfaces[next++]));
  }
  return result;
}

RegionId AmbientRegistry::addRegion(FluidRegion region) {
  return changeRegions([&](FluidRegions& regions) { return regions.add(std::move(region)); });
}

void AmbientRegistry::setRegion(RegionId id, FluidRegion region) {
  changeRegions([&](FluidRegions& regions) {
    regions.set(id, std::move(region));
    return id;
  });
}

bool AmbientRegistry::removeRegion(RegionId id) {
  return changeRegions([&](FluidRegions& regions) { return regions.remove(id); });
}

RegionId AmbientRegistry::region(const btRigidBody& body) const {
  return bodies_->require(body).place.region;
}

double AmbientRegistry::time() const { return bodies_->regions.time; }

Matrix6 AmbientRegistry::inertia(const btRigidBody& body) const {
  return modelNow(bodies_->require(body)).inertia;
}

std::size_t AmbientRegistry::size() const { return bodies_->size(); }

AmbientCounters AmbientRegistry::counters(const btRigidBody& body) const {
  return bodies_->require(body).counters;
}

AmbientCounters AmbientRegistry::counters() const {
  AmbientCounters sum;
  for (const auto& ambient : bodies_->all()) sum += ambient->counters;
  return sum;
}

void AmbientRegistry::setReport(std::function<void(const std::string&)> report) {
  bodies_->complaints.report = std::move(report);
}

void AmbientRegistry::setTaskRunner(TaskRunner* runner) { bodies_->task_runner = runner; }

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
