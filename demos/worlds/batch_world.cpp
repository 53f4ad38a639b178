#include "demos/worlds/batch_world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/simulation/robots/scene_robot.h"
#include "demos/worlds/observations.h"

namespace ambient {
namespace {

Vector3 vectorAt(const double* x) { return {x[0], x[1], x[2]}; }

/// Turn about the world's z axis.
Quaternion headingOf(double angle) { return rotationFromVector({0, 0, angle}); }

}  // namespace

void BatchWorld::Flow::at(double share, double env_step) {
  now.velocity = current + gust_before + share * (gust - gust_before);
  now.acceleration = (gust - gust_before) / env_step;
}

BatchWorld::BatchWorld(const BatchPlan& plan, std::uint64_t seed, const BatchRows& rows)
    : plan_(plan),
      seed_(seed),
      rows_(rows),
      flow_(plan.hasFlow() ? std::make_unique<Flow>() : nullptr),
      numbers_(static_cast<std::size_t>(plan.most_numbers)),
      before_(plan.accelerated.size()) {
  FlowField field;
  if (flow_) field = [flow = flow_.get()](const Vector3&, double) { return flow->now; };
  simulation_ = std::make_unique<Simulation>(plan.scene, plan.bodies, false, std::move(field));
}

RandomNumbers BatchWorld::numbers(RandomStream stream) const {
  return RandomNumbers({seed_, stream, episodes_, static_cast<std::uint64_t>(steps_)});
}

void BatchWorld::setSeed(std::uint64_t seed) {
  seed_ = seed;
  episodes_ = 0;
}

void BatchWorld::draw() {
  RandomNumbers random = numbers(RandomStream::kVariations);
  for (const VariationField& v : plan_.variations)
    for (std::size_t i = 0; i < v.lowest.size(); ++i) {
      const double x = v.lowest[i] + (v.highest[i] - v.lowest[i]) * random.uniform();
      rows_.parameters[v.field.offset + static_cast<int>(i)] =
          v.is_logarithmic ? portable::exp(x) : x;
    }
}

const double* BatchWorld::find(VariationKind kind, std::size_t body) const {
  for (const VariationField& v : plan_.variations)
    if (v.kind == kind && (body == kAny || v.body == body))
      return rows_.parameters + v.field.offset;
  return nullptr;
}

void BatchWorld::applyMass(std::size_t body) {
  const auto factor = [&](VariationKind kind) {
    const double* found = find(kind, body);
    return found ? *found : 1.0;
  };
  const double mass = factor(VariationKind::kMass), moments = factor(VariationKind::kInertia);
  if (mass != 1 || moments != 1) simulation_->scaleMass(body, mass, mass * moments);
  const double friction = factor(VariationKind::kFriction);
  if (friction != 1) simulation_->scaleFriction(body, friction);
  const BodyDef& def = plan_.scene.bodies[body];
  simulation_->setFactors(body, def.attach.added_mass_factor * factor(VariationKind::kAddedMass),
                          def.attach.load_factor * factor(VariationKind::kLoads));
}

void BatchWorld::moveCentre(std::size_t body) {
  if (const double* offset = find(VariationKind::kCentreOfMass, body))
    simulation_->moveCentre(body, plan_.bodies[body], vectorAt(offset));
}

void BatchWorld::placeBody(std::size_t body) {
  const double* position = find(VariationKind::kPosition, body);
  const double* heading = find(VariationKind::kHeading, body);
  const double* attitude = find(VariationKind::kAttitude, body);
  const double* twist = find(VariationKind::kTwist, body);
  const Quaternion before = headingOf(heading ? *heading : 0);
  const Quaternion after =
      rotationFromVector(attitude ? vectorAt(attitude) : Vector3(Vector3::Zero()));
  const Vector3 way = position ? vectorAt(position) : Vector3(Vector3::Zero());
  const auto faster = [&](Twist x) {
    if (!twist) return x;
    return Twist{x.angular + vectorAt(twist), x.linear + vectorAt(twist + 3)};
  };
  const bool is_placed = position || heading || attitude;
  const auto& link = plan_.scene.bodies[body].link;
  if (!link) {
    const MotionSample start = simulation_->sample(body);
    if (is_placed)
      simulation_->setPose(body, start.position + way, before * start.orientation * after);
    if (twist) simulation_->setTwist(body, faster(start.twist));
    return;
  }
  SceneRobot& changed = simulation_->changedRobot(link->robot);
  const Twist base = changed.sample(0).twist;
  Robot& robot = changed.robot();
  if (is_placed) {
    RigidPose pose = robot.linkPose(-1) * robot.model().links.front().joint.origin.inverse();
    pose.linear() = Matrix3(before * Quaternion(Matrix3(pose.linear())) * after);
    pose.translation() += way;
    robot.setPose(pose);
  }
  if (twist) robot.setTwist(faster(plan_.scene.robots[link->robot].fixed_base ? Twist{} : base));
}

void BatchWorld::setHardware(Simulation& simulation) const {
  const double* thrusts = find(VariationKind::kThrust);
  const double* lag = find(VariationKind::kLag);
  for (std::size_t i = 0; i < simulation.thrusters().size(); ++i)
    simulation.thrusters().setFactors(i, thrusts ? thrusts[i] : 1, lag ? *lag : 1);
  for (const VariationField& v : plan_.variations)
    if (v.kind == VariationKind::kCentreOfMass)
      simulation.setCentre(v.body, plan_.bodies[v.body],
                           vectorAt(rows_.parameters + v.field.offset));
}

void BatchWorld::setFlowAndThrusters() {
  Thrusters& thrusters = simulation_->thrusters();
  for (std::size_t i = 0; i < thrusters.size(); ++i) thrusters.command(i, thrusters.def(i).command);
  SceneFoils& foils = simulation_->foils();
  for (std::size_t i = 0; i < foils.size(); ++i) foils.command(i, foils.def(i).command);
  const double* target = find(VariationKind::kTarget);
  target_ = target ? vectorAt(target) : Vector3(Vector3::Zero());
  const double* gust = find(VariationKind::kGust);
  gust_factor_ = gust ? *gust : 1;
  const double* current = find(VariationKind::kCurrent);
  if (flow_) flow_->current = current ? vectorAt(current) : Vector3(Vector3::Zero());
  makeGusts();
}

void BatchWorld::apply() {
  setHardware(*simulation_);
  setFlowAndThrusters();
  if (flow_) flow_->at(0, plan_.envStep());
  std::size_t joint = 0;
  if (const double* offsets = find(VariationKind::kJointPosition))
    for (const BatchJoint& of : plan_.joints) {
      Robot& robot = simulation_->changedRobot(of.robot).robot();
      robot.setPosition(of.name, robot.position(of.name) + offsets[joint++]);
    }
  for (std::size_t body = 0; body < plan_.bodies.size(); ++body) {
    const auto varies = [body](const VariationField& v) { return v.body == body; };
    if (std::none_of(plan_.variations.begin(), plan_.variations.end(), varies)) continue;
    moveCentre(body);
    placeBody(body);
    applyMass(body);
  }
}

void BatchWorld::makeGusts() {
  if (!flow_ || !plan_.settings.gust) return;
  GaussMarkovGusts gusts = *plan_.settings.gust;
  const auto stream = static_cast<std::uint64_t>(RandomStream::kGust);
  gusts.seed = philox({0, stream, episodes_, 0}, {seed_, 0})[0];
  flow_->gusts = gaussMarkovGusts(gusts);
  flow_->gust_before = gustAfter(std::max(steps_ - 1, 0LL));
  flow_->gust = gustAfter(steps_);
}

Vector3 BatchWorld::gustAfter(long long steps) const {
  const double time = static_cast<double>(steps) * plan_.envStep();
  return gust_factor_ * flow_->gusts({0, 0, 0}, time).velocity;
}

void BatchWorld::reset(const SimulationState& start, bool draws) {
  fault_.clear();
  steps_ = 0;
  ++episodes_;
  if (draws) draw();
  try {
    simulation_->restore(start);
    apply();
    readWrenches();
  } catch (const std::exception& error) {
    fail(error.what());
  }
  observe();
}

bool BatchWorld::isActionFinite() {
  for (const ActionField& action : plan_.actions)
    for (int i = 0; i < action.field.size; ++i) {
      if (std::isfinite(rows_.action[action.field.offset + i])) continue;
      fail("the action " + action.field.name + "[" + std::to_string(i) + "] is not finite");
      return false;
    }
  return true;
}

void BatchWorld::setMotors(const ActionField& field) {
  for (std::size_t i = 0; i < field.rows.size(); ++i) {
    const BatchJoint& joint = plan_.joints[static_cast<std::size_t>(field.rows[i])];
    const auto& motors = plan_.scene.robots[joint.robot].motors;
    JointDrive drive = motors.at(joint.name);
    drive.amplitude = 0;
    const double asked = field.scale * rows_.action[field.field.offset + static_cast<int>(i)];
    drive.velocity.reset();
    if (field.kind == ActionKind::kMotorVelocity) {
      drive.velocity = asked;
    } else {
      drive.position = asked;
    }
    simulation_->robot(joint.robot).setDrive(joint.name, drive);
  }
}

void BatchWorld::push(const ActionField& field) {
  std::fill(numbers_.begin(), numbers_.end(), 0.0);
  for (std::size_t i = 0; i < field.rows.size(); ++i)
    numbers_[static_cast<std::size_t>(field.rows[i])] =
        field.scale * rows_.action[field.field.offset + static_cast<int>(i)];
  if (field.kind == ActionKind::kJointTorque) {
    for (std::size_t i = 0; i < plan_.joints.size(); ++i)
      if (numbers_[i] != 0)
        simulation_->robot(plan_.joints[i].robot).addJointTorque(plan_.joints[i].name, numbers_[i]);
    return;
  }
  Wrench wrench{vectorAt(numbers_.data()), vectorAt(numbers_.data() + 3)};
  if (field.kind == ActionKind::kWrench) {
    const Quaternion to_W = simulation_->sample(field.body).orientation;
    wrench = {to_W * wrench.torque, to_W * wrench.force};
  }
  simulation_->apply(field.body, wrench);
}

void BatchWorld::command(const ActionField& field) {
  const double* asked = rows_.action + field.field.offset;
  for (std::size_t i = 0; i < field.rows.size(); ++i) {
    const auto row = static_cast<std::size_t>(field.rows[i]);
    const double command = std::clamp(field.scale * asked[i], -1.0, 1.0);
    if (field.kind == ActionKind::kFoils)
      simulation_->foils().command(row, command);
    else
      simulation_->thrusters().command(row, command);
  }
}

void BatchWorld::act(bool is_first) {
  for (const ActionField& action : plan_.actions) {
    switch (action.kind) {
      case ActionKind::kThrusters:
      case ActionKind::kFoils:
        if (is_first) command(action);
        break;
      case ActionKind::kMotorPosition:
      case ActionKind::kMotorVelocity:
        if (is_first) setMotors(action);
        break;
      default:
        push(action);
    }
  }
}

bool BatchWorld::begin() {
  if (!fault_.empty()) return false;
  if (!isActionFinite()) {
    observe();
    return false;
  }
  ++steps_;
  if (flow_ && flow_->gusts) flow_->gust_before = std::exchange(flow_->gust, gustAfter(steps_));
  return true;
}

void BatchWorld::substep(int k) noexcept {
  if (!fault_.empty()) return;
  const int substeps = plan_.settings.substeps;
  try {
    if (flow_) flow_->at(static_cast<double>(k) / substeps, plan_.envStep());
    act(k == 0);
    if (k == substeps - 1)
      for (std::size_t i = 0; i < before_.size(); ++i)
        before_[i] = simulation_->sample(plan_.accelerated[i]).twist;
    simulation_->stepUnchecked();
    if (auto sentence = simulation_->fault()) fail(std::move(*sentence));
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void BatchWorld::end() {
  if (flow_) flow_->at(1, plan_.envStep());
  observe();
}

bool BatchWorld::isTruncated() const {
  return plan_.settings.most_steps > 0 && steps_ >= plan_.settings.most_steps;
}

void BatchWorld::readWrenches() {
  for (const ObservationField& observation : plan_.observations)
    if (observation.read == findObservation("fluid_wrench")->read)
      for (const bool is_read : {false, true}) simulation_->readWrench(observation.body, is_read);
}

void BatchWorld::observe() {
  if (!fault_.empty()) {
    std::fill_n(rows_.observation, plan_.observation_size,
                std::numeric_limits<double>::quiet_NaN());
    return;
  }
  ObservationView view{plan_, *simulation_, rows_.parameters};
  view.target = target_;
  if (plan_.settings.most_steps > 0)
    view.time_share = static_cast<double>(steps_) / static_cast<double>(plan_.settings.most_steps);
  for (const ObservationField& observation : plan_.observations) {
    if (view.field == nullptr || view.field->body != observation.body) {
      view.now = simulation_->sample(observation.body);
      view.to_W = view.now.orientation.toRotationMatrix();
    }
    view.field = &observation;
    view.place = observation.place;
    if (const double* offset = find(VariationKind::kCentreOfMass, observation.body))
      view.place -= vectorAt(offset);
    if (steps_ > 0 && observation.accelerated >= 0)
      view.before = before_[static_cast<std::size_t>(observation.accelerated)];
    observation.read(view, numbers_.data());
    double* to = rows_.observation + observation.field.offset;
    for (const int row : observation.rows) *to++ = numbers_[static_cast<std::size_t>(row)];
  }
  addNoise();
}

// Draws for every reading, so that a sensor's noise does not depend on others' settings.
void BatchWorld::addNoise() {
  const auto is_noisy = [](const ObservationField& o) { return o.noise > 0 || o.bias > 0; };
  if (std::none_of(plan_.observations.begin(), plan_.observations.end(), is_noisy)) return;
  RandomNumbers noise = numbers(RandomStream::kNoise);
  RandomNumbers bias({seed_, RandomStream::kBiases, episodes_, 0});
  double* reading = rows_.observation;
  for (const ObservationField& observation : plan_.observations)
    for (int i = 0; i < observation.field.size; ++i)
      *reading++ += observation.noise * noise.normal() + observation.bias * bias.normal();
}

void BatchWorld::fail(std::string sentence) { fault_ = std::move(sentence); }

/// First bytes of a state.
struct BatchWorld::Head {
  char magic[8] = {'A', 'M', 'B', 'B', 'A', 'T', 'C', 'H'};
  std::uint64_t version = 2, seed = 0, episodes = 0;
  std::int64_t steps = 0;
};

FlowField BatchWorld::flowNow() const {
  if (!flow_) return nullptr;
  const FlowSample now{flow_->now.velocity, Vector3::Zero()};
  return [now](const Vector3&, double) { return now; };
}

void BatchWorld::copyTo(Simulation& other) const {
  other.restoreState(saveSimulation());
  setHardware(other);
  for (std::size_t i = 0; i < other.thrusters().size(); ++i)
    other.thrusters().command(i, simulation_->thrusters().command(i));
  for (std::size_t i = 0; i < other.foils().size(); ++i)
    other.foils().command(i, simulation_->foils().command(i));
}

std::string BatchWorld::saveSimulation() const {
  if (!fault_.empty()) throw std::runtime_error("a world that has failed has no state: " + fault_);
  return simulation_->saveState();
}

std::string BatchWorld::saveState() const {
  const std::string simulation = saveSimulation();
  Head head;
  head.seed = seed_;
  head.episodes = episodes_;
  head.steps = steps_;
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof head);
  bytes.append(reinterpret_cast<const char*>(rows_.parameters),
               static_cast<std::size_t>(plan_.parameter_size) * sizeof(double));
  bytes.append(reinterpret_cast<const char*>(before_.data()), before_.size() * sizeof(Twist));
  return bytes + simulation;
}

void BatchWorld::restoreState(std::string_view bytes) {
  Head head;
  const std::size_t parameters = static_cast<std::size_t>(plan_.parameter_size) * sizeof(double);
  const std::size_t twists = before_.size() * sizeof(Twist);
  const std::size_t size = sizeof head + parameters + twists;
  if (bytes.size() < size || std::memcmp(bytes.data(), head.magic, sizeof head.magic) != 0)
    throw std::runtime_error("saved state: is not one of a world of this batch");
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.version != 2 || head.steps < 0)
    throw std::runtime_error("saved state: is of another version, or damaged");
  const char* from = bytes.data() + sizeof head;
  std::vector<double> numbers((parameters + twists) / sizeof(double));
  std::copy_n(from, parameters + twists, reinterpret_cast<char*>(numbers.data()));
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
    throw std::runtime_error("saved state: is damaged: a number is not finite");
  simulation_->restoreState(bytes.substr(size));
  std::copy_n(from, parameters, reinterpret_cast<char*>(rows_.parameters));
  std::copy_n(from + parameters, twists, reinterpret_cast<char*>(before_.data()));
  seed_ = head.seed;
  episodes_ = head.episodes;
  steps_ = head.steps;
  fault_.clear();
  setHardware(*simulation_);
  setFlowAndThrusters();
  if (flow_) flow_->at(1, plan_.envStep());
  readWrenches();
  observe();
}

}  // namespace ambient
