#include "demos/simulation/simulation.h"

#include <cstring>
#include <stdexcept>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/state/world_state.h"
#include "demos/simulation/simulation_world.h"

namespace ambient {
namespace {

/// Sets the law of all bodies: the bytes of a state cannot hold a function.
void setLaw(WorldState& state, const LoadLaw& law) {
  for (BodyState& body : state.bodies)
    if (body.ambient) body.ambient->def.flow.own_law = law;
  for (MultiBodyState& body : state.multi_bodies)
    for (LinkFluidState& fluid : body.fluids) fluid.ambient.def.flow.own_law = law;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const std::vector<PreparedBody>& bodies,
                       bool takes_robots)
    : world_(std::make_unique<SimulationWorld>(scene, bodies, takes_robots)) {}

Simulation::~Simulation() = default;

bool Simulation::takesRobots() const { return world_->bullet.multi_body_world != nullptr; }

void Simulation::addRobots(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  world_->addRobots(scene, bodies);
}

SceneRobot& Simulation::robot(std::size_t index) const { return *world_->robots.at(index); }

void Simulation::step() { world_->step(); }

double Simulation::time() const { return world_->time(); }

std::vector<MotionSample> Simulation::sample() const {
  std::vector<MotionSample> samples;
  for (const WorldBody& body : world_->bodies) samples.push_back(world_->sample(body));
  return samples;
}

void Simulation::applyForce(std::size_t body, const Vector3& force, const Vector3& point) {
  const WorldBody& of = world_->bodies.at(body);
  const Vector3 arm = point - world_->sample(of).position;
  world_->apply(of, {arm.cross(force), force});
}

void Simulation::applyTorque(std::size_t body, const Vector3& torque) {
  world_->apply(world_->bodies.at(body), {torque, Vector3::Zero()});
}

void Simulation::setMedium(std::size_t body, const Medium& medium) {
  const WorldBody& of = world_->bodies.at(body);
  try {
    world_->setMedium(of, medium);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("body \"" + of.name + "\": " + error.what());
  }
}

void Simulation::readWrench(std::size_t body, bool is_read) {
  if (const auto& immersed = world_->bodies.at(body).immersed) immersed->readWrench(is_read);
}

FluidWrench Simulation::wrench(std::size_t body) const {
  const auto& immersed = world_->bodies.at(body).immersed;
  return immersed ? immersed->wrench() : FluidWrench{};
}

WetState Simulation::wet(std::size_t body) const {
  const auto& immersed = world_->bodies.at(body).immersed;
  return immersed ? immersed->wet() : WetState{};
}

std::string Simulation::saveState() const {
  std::string bytes(sizeof world_->steps, '\0');
  std::memcpy(bytes.data(), &world_->steps, sizeof world_->steps);
  return bytes + encodeState(world_->fluid.save());
}

void Simulation::restoreState(std::string_view bytes) {
  SimulationWorld& w = *world_;
  const std::string source = "saved state";
  if (bytes.size() < sizeof w.steps) throw std::runtime_error(source + ": is cut short");
  long long steps = 0;
  std::memcpy(&steps, bytes.data(), sizeof steps);
  if (steps < 0) throw std::runtime_error(source + ": is damaged: its steps are below 0");
  const auto lookup = [&w](const std::string& name) { return w.findFluidBody(name); };
  WorldState state = decodeState(bytes.substr(sizeof steps), source, lookup);
  setLaw(state, w.own_law);
  w.fluid.restore(state);
  w.steps = steps;
}

const std::string& Simulation::warning() const { return world_->report; }

FlightWork Simulation::work(std::size_t body) const {
  const AmbientCounters counters = world_->counters(world_->bodies.at(body));
  return {counters.substeps, counters.load_evaluations, counters.guarded,       counters.coarse,
          counters.too_long, counters.halted,           counters.energy_removed};
}

}  // namespace ambient
