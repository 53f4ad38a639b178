#include "demos/pybullet/fluid_plugin.h"

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <cstdio>
#include <cstring>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <typeinfo>
#include <utility>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/robot_dynamics.h"
#include "demos/pybullet/world_fluid.h"
#include "demos/scene/scene_parts.h"

namespace ambient::pybullet {
namespace {

using json = nlohmann::ordered_json;

// Returns a matrix as JSON, row by row.
std::string text(const Eigen::MatrixXd& matrix) {
  json rows = json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    json numbers = json::array();
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
      numbers.push_back(matrix(row, column));
    rows.push_back(std::move(numbers));
  }
  return rows.dump();
}

std::unique_ptr<WorldFluid> makeFluid(btDiscreteDynamicsWorld* world,
                                      std::set<std::string>& printed,
                                      std::function<void()> at_end) {
  auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(world);
  if (!multi_bodies)
    throw std::invalid_argument("this PyBullet has another kind of world than the plugin knows");
  const btConstraintSolver* solver = multi_bodies->getConstraintSolver();
  if (solver && std::strstr(typeid(*solver).name(), "FluidSolver"))
    throw std::invalid_argument("another copy of this plugin has its fluid in this world");
  return std::make_unique<WorldFluid>(*multi_bodies, printed, std::move(at_end));
}

// Returns the cache of all clients of the process that keep fluid bodies in this folder, "": the
// user's.
std::shared_ptr<FluidBodyCache> sharedShapes(const std::string& folder) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<FluidBodyCache>> caches;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<FluidBodyCache>& cache = caches[folder];
  const auto place = [&] { return folder.empty() ? userBodyFolder() : BodyFolder(folder); };
  if (!cache) cache = std::make_shared<FluidBodyCache>(CollisionShapeSettings(), place());
  return cache;
}

}  // namespace

const std::map<std::string, FluidPlugin::Answer> FluidPlugin::kCommands = {
    {"water", &FluidPlugin::setRegion},
    {"air", &FluidPlugin::setRegion},
    {"region", &FluidPlugin::setRegion},
    {"remove", &FluidPlugin::removeRegion},
    {"settings", &FluidPlugin::setSettings},
    {"body", &FluidPlugin::chooseBody},
    {"equip", &FluidPlugin::equip},
    {"drive", &FluidPlugin::drive},
    {"drives", &FluidPlugin::drives},
    {"exclude", &FluidPlugin::exclude},
    {"inertia", &FluidPlugin::inertia},
    {"mass_matrix", &FluidPlugin::massMatrix},
    {"wrench", &FluidPlugin::wrench},
    {"wet", &FluidPlugin::wet},
    {"save", &FluidPlugin::save},
    {"restore", &FluidPlugin::restore},
    {"status", &FluidPlugin::status},
    {"off", &FluidPlugin::leave},
};

// The world tells its end itself: a step may come before the notification of resetSimulation.
void FluidPlugin::meetWorld() {
  if (fluid_ || !refusal_.empty()) return;
  try {
    fluid_ = makeFluid(findWorld(server_, client_), printed_, [this] { forgetWorld(); });
    for (auto& [name, region] : regions_) region.id = fluid_->fluid().addRegion(region.region);
  } catch (const std::exception& error) {
    fluid_.reset();
    refusal_ = error.what();
    std::fprintf(stderr, "bullet_ambient: %s\n", refusal_.c_str());
  }
}

void FluidPlugin::forgetWorld() {
  fluid_.reset();
  equipment_ = {};
  equipment_states_.clear();
  refusal_.clear();
  has_news_ = true;
}

void FluidPlugin::notice(const Notification* notifications, int count) {
  for (int i = 0; i < count; ++i) {
    const Notification& notification = notifications[i];
    if (notification.type == kSimulationReset) forgetWorld();
    if (notification.type == kBodyAdded) has_news_ = true;
    if (notification.type != kBodyRemoved || !fluid_) continue;
    fluid_->forget(notification.body);
    equipment_.forget(notification.body, WorldFluid::kAllLinks);
  }
}

void FluidPlugin::beforeStep() {
  refresh();
  if (fluid_ && !equipment_.isEmpty()) pushByEquipment();
}

// Bullet has the length of the substep that begins from the one before.
void FluidPlugin::pushByEquipment() {
  equipment_.push(fluid_->timeStep(), *fluid_, [this](RegionId id) -> const FluidRegion* {
    for (const auto& [name, region] : regions_)
      if (region.id == id) return &region.region;
    return nullptr;
  });
}

void FluidPlugin::refresh() {
  if (regions_.empty() && !fluid_) return;
  meetWorld();
  if (!fluid_) return;
  const bool adds = has_news_ && !regions_.empty();
  try {
    fluid_->prepare({shapes(), flow_}, adds);
  } catch (const std::exception& error) {
    fluid_.reset();
    refusal_ = error.what();
    throw;
  }
  if (adds) has_news_ = false;
}

FluidBodyCache& FluidPlugin::shapes() {
  if (!shapes_) shapes_ = sharedShapes(folder_);
  return *shapes_;
}

WorldFluid& FluidPlugin::requireFluid() {
  meetWorld();
  if (!fluid_) throw std::invalid_argument(refusal_);
  return *fluid_;
}

WorldFluid& FluidPlugin::requireCurrent() {
  requireFluid();
  refresh();
  return requireFluid();
}

// The limit of the roughness hangs on the body. Bodies that are in the fluid have passed.
void FluidPlugin::checkOnBodies(const FlowSettings& flow, const std::string& folder) {
  if (!(flow.roughness > 0)) return;
  meetWorld();
  if (fluid_ && !fluid_->hasBodies()) fluid_->check(flow, *sharedShapes(folder));
}

std::string FluidPlugin::setRegion(const Command& command) {
  const std::string name = command.values.value("name", command.name);
  FluidRegion region = makeRegion(command);
  meetWorld();
  checkOnBodies(flow_, folder_);
  const auto ours = regions_.find(name);
  const RegionId id = ours == regions_.end() ? RegionId::kNone : ours->second.id;
  if (fluid_ && id != RegionId::kNone) fluid_->fluid().setRegion(id, region);
  const bool adds = fluid_ && id == RegionId::kNone;
  const RegionId now = adds ? fluid_->fluid().addRegion(region) : id;
  regions_[name] = {std::move(region), now};
  return refusal_;
}

std::string FluidPlugin::removeRegion(const Command& command) {
  const auto region = regions_.find(command.values.value("name", "water"));
  if (region == regions_.end()) command.fail("there is no such region");
  if (fluid_) fluid_->fluid().removeRegion(region->second.id);
  regions_.erase(region);
  return "";
}

std::string FluidPlugin::setSettings(const Command& command) {
  if (fluid_ && fluid_->hasBodies())
    command.fail("comes too late: bodies are in the fluid; give it before the first step");
  FlowSettings flow = flow_;
  flow.law = lawOr(command.values, flow.law);
  flow.roughness = command.values.value("roughness", flow.roughness);
  flow.separation_angle = command.values.value("separation", flow.separation_angle);
  if (const auto fault = faultOf(flow)) {
    std::ostringstream sentence;
    sentence << fault->quantity << " [" << fault->unit << "] is " << fault->value << "; must be "
             << fault->limit;
    command.fail(sentence.str());
  }
  const std::string folder = command.values.value("folder", folder_);
  checkOnBodies(flow, folder);
  flow_ = flow;
  if (folder != folder_) shapes_.reset();
  folder_ = folder;
  return "";
}

std::string FluidPlugin::exclude(const Command& command) {
  const int link = command.link(WorldFluid::kAllLinks);
  requireFluid().exclude(command.body(), link);
  equipment_.forget(command.body(), link);
  return "";
}

std::string FluidPlugin::chooseBody(const Command& command) {
  const ChosenBody chosen = readChosenBody(command, flow_);
  requireFluid().choose(command.body(), command.link(-1), chosen, shapes());
  return "";
}

std::string FluidPlugin::equip(const Command& command) {
  equipment_.add(command, requireCurrent(), {shapes(), flow_});
  return "";
}

std::string FluidPlugin::drive(const Command& command) {
  equipment_.drive(command);
  return "";
}

std::string FluidPlugin::drives(const Command&) { return equipment_.state().dump(); }

std::string FluidPlugin::inertia(const Command& command) {
  return text(requireCurrent().require(command.body(), command.link(-1)).inertia());
}

std::string FluidPlugin::massMatrix(const Command& command) {
  WorldFluid& fluid = requireCurrent();
  return text(ambientMassMatrix(fluid.fluid(), fluid.multiBody(command.body())));
}

// Returns the parts of the fluid's wrench. They are computed in each step from the first call on.
std::string FluidPlugin::wrench(const Command& command) {
  const Immersed one = requireCurrent().require(command.body(), command.link(-1));
  one.readWrench(true);
  const FluidWrench parts = one.wrench();
  json answer;
  for (const auto& [name, part] : kWrenchParts) {
    const Vector6 numbers = (parts.*part).vector();
    answer[name] = std::vector<double>(numbers.begin(), numbers.end());
  }
  return answer.dump();
}

std::string FluidPlugin::wet(const Command& command) {
  const WetState wet = requireCurrent().require(command.body(), command.link(-1)).wet();
  const Vector3& centre = wet.centre_of_buoyancy;
  json answer;
  answer["volume"] = wet.volume;
  answer["share"] = wet.share;
  answer["draught"] = wet.draught;  // infinite, null in JSON, if no surface is near
  answer["area"] = wet.area;
  answer["centre_of_buoyancy"] = {centre.x(), centre.y(), centre.z()};
  return answer.dump();
}

std::string FluidPlugin::save(const Command&) {
  const std::size_t state = requireCurrent().save();
  equipment_states_.push_back(equipment_.saved());
  return std::to_string(state);
}

std::string FluidPlugin::restore(const Command& command) {
  const auto state = command.values.at("state").get<std::size_t>();
  requireCurrent().restore(state);
  equipment_.restore(equipment_states_[state]);
  return "";
}

std::string FluidPlugin::status(const Command&) {
  meetWorld();
  json status;
  for (const auto& [name, region] : regions_) status["regions"].push_back(name);
  if (!refusal_.empty()) status["refused"] = refusal_;
  const FluidBodyCache::Counts counts = shapes().counts();
  status["shapes"] = {{"made", counts.made}, {"read", counts.read}};
  if (fluid_) {
    const AmbientCounters counters = fluid_->fluid().counters();
    status["members"] = fluid_->fluid().size();
    status["time"] = fluid_->fluid().time();
    status["substeps"] = counters.substeps;
    status["rows"] = counters.rows;
    status["coarse"] = counters.coarse;
    status["halted"] = counters.halted;
    status["rejected"] = counters.rejected;
    status["energy_removed"] = counters.energy_removed;
    status["said"] = fluid_->said();
    status["bodies"] = json::array();
    fluid_->forEach([&](int body, int link, double mass, const FluidBody& shape) {
      json one;
      one["body"] = body;
      one["link"] = link;
      one["mass"] = mass;
      one["volume"] = shape.volume;
      if (shape.volume > 0) one["density"] = mass / shape.volume;
      one["shape"] = shape.name;
      one["made"] = shape.provenance.source + "; " + shape.provenance.settings;
      one["said"] = shapes().said(shape);
      status["bodies"].push_back(std::move(one));
    });
  }
  return status.dump();
}

// Ends the fluid: PyBullet simulates as without the plugin.
std::string FluidPlugin::leave(const Command&) {
  regions_.clear();
  forgetWorld();
  return "";
}

// A text with '+' first is a piece of a longer command: it is kept until a piece without '+' comes.
std::string FluidPlugin::execute(const Arguments& arguments) {
  const std::string piece = arguments.text;
  if (!piece.empty() && piece[0] == '+') {
    pieces_ += piece.substr(1);
    return "";
  }
  const Command command(std::exchange(pieces_, "") + piece);
  return (this->*kCommands.at(command.name))(command);
}

}  // namespace ambient::pybullet
