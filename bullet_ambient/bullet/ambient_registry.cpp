#include "bullet_ambient/bullet/ambient_registry.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/attach_body.h"
#include "bullet_ambient/bullet/attach_link.h"
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
}

// Whether the fluid is another one than before.
bool changeMedium(AmbientBody& ambient, const Medium& medium, AmbientBodies& bodies) {
  checkMedium(*ambient.def.fluid_body, medium);
  const Medium before = ambient.def.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    AttachDef def = ambient.def;
    def.medium = medium;
    replaceDef(ambient, std::move(def), bodies);
    return true;
  }
  if (medium.velocity == before.velocity && medium.acceleration == before.acceleration)
    return false;
  ambient.def.medium = medium;
  if (ambient.place.region == RegionId::kNone) ambient.medium = medium;
  return true;
}

void changeFluidBody(AmbientBody& ambient, std::shared_ptr<const FluidBody> fluid_body,
                     const FrameOffset& fluid_frame, AmbientBodies& bodies) {
  if (!fluid_body) throw std::invalid_argument("setFluidBody: the fluid body is null");
  AttachDef def = ambient.def;
  def.fluid_body = std::move(fluid_body);
  def.fluid_frame = fluid_frame;
  replaceDef(ambient, std::move(def), bodies);
}

// Makes all loads first: what throws changes nothing.
void learnAll(AmbientBodies& bodies, const RegionFluids& fluids) {
  if (fluids.empty()) return;
  std::vector<KnownFluids> made;
  bodies.forEach([&](const AmbientBody& ambient) {
    made.push_back(makeKnownFluids(ambient.def, fluids, bodies.load_tables));
  });
  std::size_t next = 0;
  bodies.forEach([&](AmbientBody& ambient) { learnFluids(ambient, std::move(made[next++])); });
}

void forgetAll(AmbientBodies& bodies, const RegionFluids& fluids) {
  if (fluids.empty()) return;
  bodies.forEach([&](AmbientBody& ambient) { forgetFluids(ambient, fluids); });
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
  bodies_->requireChangeable("attach");
  attachBody(*bodies_, body, std::move(def));
  const AmbientBody& ambient = bodies_->require(body);
  const DisplacedMass mass = displacedMass(ambient);
  if (mass.isMuchLighter()) sayLight(bodies_->complaints, *ambient.def.fluid_body, mass, 1);
}

bool AmbientRegistry::detach(const btRigidBody& body) {
  bodies_->requireChangeable("detach");
  return bodies_->erase(body);
}

void AmbientRegistry::clear() {
  bodies_->requireChangeable("clear");
  bodies_->clear();
}

bool AmbientRegistry::isAttached(const btRigidBody& body) const { return bodies_->find(&body); }

void AmbientRegistry::setMedium(const btRigidBody& body, const Medium& medium) {
  bodies_->requireChangeable("setMedium");
  AmbientBody& ambient = bodies_->require(body);
  if (changeMedium(ambient, medium, *bodies_)) ambient.body->activate();
}

void AmbientRegistry::setFluidBody(const btRigidBody& body,
                                   std::shared_ptr<const FluidBody> fluid_body) {
  setFluidBody(body, std::move(fluid_body), bodies_->require(body).def.fluid_frame);
}

void AmbientRegistry::setFluidBody(const btRigidBody& body,
                                   std::shared_ptr<const FluidBody> fluid_body,
                                   const FrameOffset& fluid_frame) {
  bodies_->requireChangeable("setFluidBody");
  AmbientBody& ambient = bodies_->require(body);
  changeFluidBody(ambient, std::move(fluid_body), fluid_frame, *bodies_);
  ambient.body->activate();
}

const Medium& AmbientRegistry::medium(const btRigidBody& body) const {
  return bodies_->require(body).medium;
}

RegionId AmbientRegistry::addRegion(FluidRegion region) {
  bodies_->requireChangeable("addRegion");
  FluidRegions& regions = bodies_->regions;
  checkRegion(regions.next(), region);
  learnAll(*bodies_, regions.missing(region));
  return regions.add(std::move(region));
}

void AmbientRegistry::setRegion(RegionId id, FluidRegion region) {
  bodies_->requireChangeable("setRegion");
  FluidRegions& regions = bodies_->regions;
  checkRegion(id, region);
  const FluidRegion before = regions.require(id);
  learnAll(*bodies_, regions.missing(region));
  regions.set(id, std::move(region));
  forgetAll(*bodies_, regions.missing(before));
}

bool AmbientRegistry::removeRegion(RegionId id) {
  bodies_->requireChangeable("removeRegion");
  FluidRegions& regions = bodies_->regions;
  const auto found = regions.all().find(id);
  if (found == regions.all().end()) return false;
  const FluidRegion before = found->second.region;
  regions.remove(id);
  forgetAll(*bodies_, regions.missing(before));
  return true;
}

RegionId AmbientRegistry::region(const btRigidBody& body) const {
  return bodies_->require(body).place.region;
}

double AmbientRegistry::time() const { return bodies_->regions.time; }

Matrix6 AmbientRegistry::inertia(const btRigidBody& body) const {
  return modelNow(bodies_->require(body)).inertia;
}

void AmbientRegistry::attach(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body, int link,
                             AttachDef def) {
  bodies_->requireChangeable("attach");
  checkWorldKind("attach", world);
  attachLink(*bodies_, world, {multi_body, link}, std::move(def));
}

bool AmbientRegistry::detach(const btMultiBody& multi_body, int link) {
  bodies_->requireChangeable("detach");
  return bodies_->trees.erase(multi_body, link);
}

bool AmbientRegistry::detach(const btMultiBody& multi_body) {
  bodies_->requireChangeable("detach");
  return bodies_->trees.erase(multi_body);
}

bool AmbientRegistry::isAttached(const btMultiBody& multi_body, int link) const {
  const AmbientTree* tree = bodies_->trees.find(&multi_body);
  return tree && tree->find(link);
}

void AmbientRegistry::setMedium(const btMultiBody& multi_body, int link, const Medium& medium) {
  bodies_->requireChangeable("setMedium");
  AmbientBody& ambient = bodies_->trees.require(multi_body, link).ambient;
  if (changeMedium(ambient, medium, *bodies_)) wake(*bodies_->trees.find(&multi_body)->multi_body);
}

void AmbientRegistry::setFluidBody(const btMultiBody& multi_body, int link,
                                   std::shared_ptr<const FluidBody> fluid_body,
                                   const FrameOffset& fluid_frame) {
  bodies_->requireChangeable("setFluidBody");
  AmbientBody& ambient = bodies_->trees.require(multi_body, link).ambient;
  changeFluidBody(ambient, std::move(fluid_body), fluid_frame, *bodies_);
  wake(*bodies_->trees.find(&multi_body)->multi_body);
}

const Medium& AmbientRegistry::medium(const btMultiBody& multi_body, int link) const {
  return bodies_->trees.require(multi_body, link).ambient.medium;
}

RegionId AmbientRegistry::region(const btMultiBody& multi_body, int link) const {
  return bodies_->trees.require(multi_body, link).ambient.place.region;
}

Matrix6 AmbientRegistry::inertia(const btMultiBody& multi_body, int link) const {
  return modelNow(bodies_->trees.require(multi_body, link).ambient).inertia;
}

AmbientCounters AmbientRegistry::counters(const btMultiBody& multi_body, int link) const {
  return bodies_->trees.require(multi_body, link).ambient.counters;
}

std::size_t AmbientRegistry::size() const { return bodies_->size(); }

AmbientCounters AmbientRegistry::counters(const btRigidBody& body) const {
  return bodies_->require(body).counters;
}

AmbientCounters AmbientRegistry::counters() const {
  AmbientCounters sum;
  bodies_->forEach([&](const AmbientBody& ambient) { sum += ambient.counters; });
  return sum;
}

void AmbientRegistry::setReport(std::function<void(const std::string&)> report) {
  bodies_->complaints.setReport(std::move(report));
}

void AmbientRegistry::setTaskRunner(TaskRunner* runner) { bodies_->task_runner = runner; }

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
