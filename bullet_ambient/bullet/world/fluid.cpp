#include "bullet_ambient/fluid.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "bullet_ambient/bullet/connection/world_connection.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/world/fluid_action.h"
#include "bullet_ambient/immersed/region_following.h"
#include "bullet_ambient/saved_state.h"

AMBIENT_BEGIN
namespace {

// Where the regions lack a fluid of a region that is to come, gives all bodies the models for it,
// too; where they lack one of a region that has gone, takes those away. Makes all models first:
// what throws changes nothing.
void knowFluids(AmbientBodies& bodies, const FluidRegion& region, bool is_coming) {
  const RegionFluids missing = bodies.regions.missing(region);
  if (missing.empty()) return;
  const RegionFluids fluids = bodies.regions.fluids(is_coming ? missing : RegionFluids{});
  std::vector<std::shared_ptr<const FluidModels>> made;
  bodies.forEach([&](const AmbientBody& ambient) {
    made.push_back(
        makeFluidModels(*ambient.def, ambient.models->inverse_mass, fluids, bodies.load_tables));
  });
  std::size_t next = 0;
  bodies.forEach([&](AmbientBody& ambient) { setModels(ambient, std::move(made[next++])); });
}

// Changes the regions by change(), and makes room for what then differs of the fluid along each
// body.
template <class Change>
void changeRegions(AmbientBodies& bodies, const Change& change) {
  const bool knew = bodies.regions.mayDiffer(), knew_layers = bodies.regions.haveLayers();
  change();
  if (bodies.regions.mayDiffer() == knew && bodies.regions.haveLayers() == knew_layers) return;
  bodies.forEach([&](AmbientBody& ambient) { makeStations(ambient, bodies.regions); });
}

// Warns of a new body or link that is light beside what it displaces. Returns it.
const AmbientBody& warnIfLight(AmbientBodies& bodies, const AmbientBody& ambient,
                               const btVector3& gravity) {
  if (const auto mass = risingMass(ambient, bodies.trees, gravity))
    warnOfLightBody(bodies.warnings, *ambient.def, *mass, 1);
  return ambient;
}

}  // namespace

AmbientBodies& ambientBodiesOf(const Fluid& fluid) { return *fluid.bodies_; }

Fluid::Fluid(btDynamicsWorld& world, SolverOwner owner)
    : bodies_(std::make_shared<AmbientBodies>()),
      action_(std::make_unique<FluidAction>(*bodies_, drawing)),
      connection_(std::make_unique<WorldConnection>(world, bodies_, *action_, owner)) {
  setReport([](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); });
}

// Solvers of the program may keep the bodies, without anything of the program's.
Fluid::~Fluid() { bodies_->close(); }

void Fluid::refit() { connection_->refit(); }

Immersed Fluid::add(btRigidBody& body, AttachDef def) {
  const btDynamicsWorld& world = connection_->world();
  bodies_->requireChangeable("add");
  const AmbientBody& ambient = attachBody(*bodies_, body, std::move(def));
  return Immersed(*bodies_, warnIfLight(*bodies_, ambient, world.getGravity()));
}

Immersed Fluid::add(btMultiBody& multi_body, int link, AttachDef def) {
  btMultiBodyDynamicsWorld& world = connection_->multiBodyWorld("add");
  bodies_->requireChangeable("add");
  const AmbientBody& ambient = attachLink(*bodies_, world, multi_body, link, std::move(def));
  return Immersed(*bodies_, warnIfLight(*bodies_, ambient, world.getGravity()));
}

AttachReport Fluid::addAll(FluidBodySource& shapes, const Medium& medium, AttachSettings settings) {
  btDiscreteDynamicsWorld& world = connection_->world();
  bodies_->requireChangeable("addAll");
  const bool later_bodies = settings.later_bodies;
  auto attachment =
      std::make_unique<WorldAttachment>(*bodies_, shapes, medium, std::move(settings));
  AttachReport report = attachment->attachNew(world);
  if (later_bodies) action_->follow(std::move(attachment));
  return report;
}

void Fluid::addLaterBodies() {
  btDiscreteDynamicsWorld& world = connection_->world();
  bodies_->requireChangeable("addLaterBodies");
  action_->attachLater(world);
}

std::optional<Immersed> Fluid::find(const btRigidBody& body) const {
  const AmbientBody* ambient = bodies_->find(&body);
  if (!ambient) return std::nullopt;
  return Immersed(*bodies_, *ambient);
}

std::optional<Immersed> Fluid::find(const btMultiBody& multi_body, int link) const {
  const AmbientLink* found = bodies_->trees.find(&multi_body, link);
  if (!found) return std::nullopt;
  return Immersed(*bodies_, found->ambient);
}

std::size_t Fluid::size() const {
  std::size_t size = 0;
  bodies_->forEach([&size](const AmbientBody&) { ++size; });
  return size;
}

void Fluid::clear() {
  bodies_->requireChangeable("clear");
  bodies_->clear();
  action_->followNothing();
}

RegionId Fluid::addRegion(FluidRegion region) {
  bodies_->requireChangeable("addRegion");
  FluidRegions& regions = bodies_->regions;
  checkRegion(regions.next(), region);
  knowFluids(*bodies_, region, true);
  RegionId id = RegionId::kNone;
  changeRegions(*bodies_, [&] { id = regions.add(std::move(region)); });
  return id;
}

void Fluid::setRegion(RegionId id, FluidRegion region) {
  bodies_->requireChangeable("setRegion");
  FluidRegions& regions = bodies_->regions;
  checkRegion(id, region);
  const FluidRegion before = regions.require(id);
  knowFluids(*bodies_, region, true);
  changeRegions(*bodies_, [&] { regions.set(id, std::move(region)); });
  knowFluids(*bodies_, before, false);
}

bool Fluid::removeRegion(RegionId id) {
  bodies_->requireChangeable("removeRegion");
  FluidRegions& regions = bodies_->regions;
  const auto found = regions.all().find(id);
  if (found == regions.all().end()) return false;
  const FluidRegion before = found->second.region;
  regions.remove(id);
  knowFluids(*bodies_, before, false);
  return true;
}

WorldState Fluid::save() const { return saveState(connection_->world(), *bodies_); }

void Fluid::restore(const WorldState& state) {
  btDynamicsWorld& world = connection_->world();
  restoreState(state, world, *bodies_);
  if (bodies_->has_vessels) findBodiesInHolds(world, *bodies_);
}

double Fluid::time() const { return bodies_->regions.time; }

AmbientCounters Fluid::counters() const {
  AmbientCounters sum;
  bodies_->forEach([&](const AmbientBody& ambient) { sum += ambient.counters; });
  return sum;
}

void Fluid::setReport(std::function<void(const std::string&)> report) {
  bodies_->warnings.setReport(std::move(report));
}

void Fluid::setNaming(std::function<std::string(const btCollisionObject&)> naming) {
  bodies_->naming = std::move(naming);
}

void Fluid::setTaskRunner(TaskRunner runner) { bodies_->task_runner = std::move(runner); }

void stepTogether(Fluid* const* fluids, int count, const std::function<void(int)>& step) {
  for (int i = 0; i < count; ++i)
    if (fluids[i]->connection_->isThreaded())
      throw std::invalid_argument("stepTogether: world " + std::to_string(i) +
                                  " solves on several threads; must be on one");
  FlightQueue queue(count, &step);
  for (int i = 0; i < count; ++i) fluids[i]->bodies_->flight_queue = &queue;
  queue.goOn();
  for (int i = 0; i < count; ++i) fluids[i]->bodies_->flight_queue = nullptr;
}

AMBIENT_END
