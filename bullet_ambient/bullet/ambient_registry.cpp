#include "bullet_ambient/bullet/ambient_registry.h"

#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/attach_body.h"
#include "bullet_ambient/bullet/region_following.h"
#include "bullet_ambient/bullet/world_tie.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

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
  attachBody(*bodies_, body, std::move(def));
  const AmbientBody& ambient = bodies_->require(body);
  const DisplacedMass mass = displacedMass(ambient);
  if (mass.isMuchLighter()) sayLight(bodies_->complaints, *ambient.def.fluid_body, mass, 1);
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
