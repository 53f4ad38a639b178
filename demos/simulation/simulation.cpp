#include "demos/simulation/simulation.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/force/medium/profiles.h"
#include "bullet_ambient/saved_state.h"
#include "demos/rivals/rival_laws.h"
#include "demos/scene/scene.h"
#include "demos/scene/scene_water.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

/// Throws if the point is more than 2^23 body sizes away: the limit of makeBodyModel().
void checkPoint(const JointDef& joint, const std::string& name, const btRigidBody& body) {
  constexpr double kSizes = 8388608;
  const double lever =
      static_cast<double>((toBullet(joint.point) - body.getWorldTransform().getOrigin()).length());
  const Vector3 moments = toVector3(body.getInvInertiaDiagLocal()).cwiseInverse();
  const double size = std::sqrt(moments.maxCoeff() * static_cast<double>(body.getInvMass()));
  if (body.getInvMass() == 0 || lever <= kSizes * size) return;
  std::ostringstream text;
  text << "joint of body \"" << name << "\": its point is " << lever
       << " m from the centre of mass; must be at most 2^23 times the radius of gyration, " << size
       << " m";
  throw std::invalid_argument(text.str());
}

/// Point and axis of a joint in the frame of one body.
struct JointEnd {
  btVector3 point, axis;

  JointEnd(const JointDef& joint, const btRigidBody& body) {
    const btTransform to_body = body.getWorldTransform().inverse();
    point = to_body * toBullet(joint.point);
    if (joint.axis) axis = to_body.getBasis() * toBullet(joint.axis->normalized());
  }
};

/// Makes Bullet's constraint for a joint; both bodies are in their poses at t = 0. `second`: null
/// for a joint to the world.
/// @throws std::invalid_argument in one line if the point is over 2^23 body sizes from a body.
std::unique_ptr<btTypedConstraint> makeJoint(const JointDef& joint, btRigidBody& first,
                                             btRigidBody* second) {
  checkPoint(joint, joint.bodies[0], first);
  if (second) checkPoint(joint, joint.bodies[1], *second);
  const JointEnd a(joint, first);
  if (!second) {
    if (!joint.axis) return std::make_unique<btPoint2PointConstraint>(first, a.point);
    return std::make_unique<btHingeConstraint>(first, a.point, a.axis);
  }
  const JointEnd b(joint, *second);
  if (!joint.axis)
    return std::make_unique<btPoint2PointConstraint>(first, *second, a.point, b.point);
  return std::make_unique<btHingeConstraint>(first, *second, a.point, b.point, a.axis, b.axis);
}

/// Load law of the scene's model; empty: this library's own.
LoadLaw loadLawOf(const Scene& scene) {
  if (scene.model == FluidModel::kIdeal)
    return [](const auto&, const auto&) { return std::shared_ptr<const SurfaceLoads>(); };
  if (scene.model == FluidModel::kUwrbd) return linearDrag(scene.linear_drag_speed);
  if (scene.model == FluidModel::kGwtf) return windwardFlux();
  return nullptr;
}

AttachDef makeAttachDef(const Scene& scene, const BodyDef& def, const PreparedBody& prepared,
                        const Matrix3& R_SB, const LoadLaw& own_law) {
  AttachDef attach = def.attach;
  attach.fluid_body = prepared.fluid_body;
  attach.flow.own_law = own_law;
  attach.flight = scene.flight;
  attach.fluid_frame.rotation = R_SB.transpose();
  attach.fluid_frame.translation =
      R_SB.transpose() * (prepared.fluid_origin - prepared.centre_of_mass);
  return attach;
}

/// Sets the law and the integrator of all bodies: the bytes of a state cannot hold a function.
void setFunctions(WorldState& state, const LoadLaw& law, OwnFlight flight) {
  const auto set = [&](AttachDef& def) {
    def.flow.own_law = law;
    def.flight.own_flight = flight;
  };
  for (BodyState& body : state.bodies)
    if (body.ambient) set(body.ambient->def);
  for (MultiBodyState& body : state.multi_bodies)
    for (LinkFluidState& fluid : body.fluids) set(fluid.ambient.def);
}

std::string notFinite(const std::string& scene, const std::string& body, double time) {
  std::ostringstream text;
  text << scene << ": body \"" << body << "\": its state is not finite at t = " << time
       << " s; a smaller time_step may help";
  return text.str();
}

/// Says what is wrong without the name of the fluid body: that of the first body of its shape.
std::string withoutName(const FluidBody& shape, const std::invalid_argument& error) {
  const std::string text = error.what(), name = "fluid body '" + shape.name + "': ";
  return text.compare(0, name.size(), name) == 0 ? text.substr(name.size()) : text;
}

/// Makes Bullet's pools of contacts fit the scene, beyond which Bullet allocates: none for a body
/// alone. Its own have room for 4096, 7 MB.
btDefaultCollisionConstructionInfo poolsFor(const Scene& scene) {
  btDefaultCollisionConstructionInfo info;
  const int others = static_cast<int>(std::min<std::size_t>(scene.bodies.size(), 513)) - 1;
  const int most = std::max(1, 8 * others);  // Bullet makes none of size 0
  info.m_defaultMaxPersistentManifoldPoolSize = most;
  info.m_defaultMaxCollisionAlgorithmPoolSize = most;
  return info;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const std::vector<PreparedBody>& prepared,
                       bool takes_robots, const FlowField& flow)
    : configuration_(poolsFor(scene)),
      bullet_(makeBulletWorld(takes_robots || !scene.robots.empty(), dispatcher_, broadphase_,
                              configuration_)),
      fluid_(*bullet_.world),
      own_law_(loadLawOf(scene)),
      own_flight_(scene.flight.own_flight),
      time_step_(scene.time_step),
      file_(scene.file.string()) {
  if (scene.bodies.empty() && !takes_robots)
    raiseInputError(file_,
                    "bodies is empty, and no robot has a link that collides; must be at least one");
  fluid_.setReport([this](const std::string& sentence) {
    if (!warning_.empty()) warning_ += '\n';
    warning_ += sentence;
  });
  bullet_.world->setGravity(toBullet(scene.gravity));
  thrusters_ = Thrusters(scene, prepared);
  foils_ = SceneFoils(scene, prepared);
  flow_ = flow;
  if (thrusters_.hasJets()) {
    flow_ = flow_ + FlowField([this](const Vector3& point, double) {
              return FlowSample{thrusters_.washAt(point, false), Vector3::Zero()};
            });
    flow_above_ = [this](const Vector3& point, double) {
      const Vector3 below = thrusters_.washAt(point, false);  // is in both fluids by flow_
      return FlowSample{thrusters_.washAt(point, true) - below, Vector3::Zero()};
    };
  }
  fluids_ = regionsOf(scene);
  for (const FluidRegion& region : fluids_) regions_.push_back(fluid_.addRegion(region));
  addRobots(scene, prepared);
  for (const JointDef& joint : scene.joints) add(joint);
}

Simulation::~Simulation() {
  for (const auto& joint : joints_) bullet_.world->removeConstraint(joint.get());
  fluid_.clear();
  removeFrom(0, 0);
}

void Simulation::removeFrom(std::size_t body, std::size_t robot) {
  for (std::size_t i = body; i < bodies_.size(); ++i) {
    if (bodies_[i].immersed) bodies_[i].immersed->remove();
    if (bodies_[i].body) bullet_.world->removeRigidBody(bodies_[i].body.get());
  }
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(body), bodies_.end());
  if (robots_) robots_->removeFrom(robot);
}

void Simulation::add(const Scene& scene, const BodyDef& def, const PreparedBody& prepared) {
  if (def.link) {
    bodies_.push_back(makeWorldLink(def, prepared, robots_->bodyToLink(*def.link)));
  } else {
    bodies_.push_back(makeWorldBody(def, prepared));
    bullet_.world->addRigidBody(bodies_.back().body.get());
  }
  WorldBody& added = bodies_.back();
  if (added.link) {
    const Twist twist = robots_->sample(*def.link).twist;
    if (!twist.vector().isZero(0)) added.start.twist = twist;
  }
  if (scene.model == FluidModel::kVacuum || !prepared.fluid_body) return;
  try {
    AttachDef attach = makeAttachDef(scene, def, prepared, added.R_SB, own_law_);
    if (scene.model == FluidModel::kAmbient) attach.flow.foils = foils_.of(bodies_.size() - 1);
    added.immersed = added.link ? fluid_.add(multiBodyOf(added), added.linkNumber(), attach)
                                : fluid_.add(*added.body, attach);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        inputMessage(file_, "body \"", def.name, "\": ", withoutName(*prepared.fluid_body, error)));
  }
}

void Simulation::add(const JointDef& def) {
  btRigidBody* second = def.bodies.size() > 1 ? &find(def.bodies[1]) : nullptr;
  try {
    joints_.push_back(makeJoint(def, find(def.bodies[0]), second));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(inputMessage(file_, error.what()));
  }
  constexpr bool kWithoutCollisions = true;
  bullet_.world->addConstraint(joints_.back().get(), kWithoutCollisions);
}

bool Simulation::takesRobots() const { return bullet_.multi_body_world != nullptr; }

// Links are the last bodies of a scene.
void Simulation::addRobots(const Scene& scene, const std::vector<PreparedBody>& prepared) {
  const std::size_t bodies = bodies_.size(), robots = robots_ ? robots_->count() : 0;
  const std::size_t said = warning_.size();
  try {
    if (robots_) {
      for (std::size_t i = robots; i < scene.robots.size(); ++i)
        robots_->add(scene.robots[i], *bullet_.multi_body_world);
      // Adds all motors to the world now: restoring a saved state requires the same constraints.
      robots_->prepareStep(robots, time(), time_step_);
    }
    for (std::size_t i = bodies; i < prepared.size(); ++i) add(scene, scene.bodies[i], prepared[i]);
  } catch (...) {
    removeFrom(bodies, robots);
    warning_.resize(said);
    throw;
  }
}

void Simulation::step() {
  stepUnchecked();
  if (const auto sentence = fault()) throw std::runtime_error(*sentence);
}

void Simulation::push() {
  thrusters_.follow(time_step_);
  foils_.follow(time_step_);
  const auto poseOf = [this](std::size_t body) { return sample(bodies_[body]); };
  const auto fluidAt = [this](std::size_t body, const Vector3& place) {
    return fluidAround(body, place);
  };
  const auto toBody = [this](std::size_t body, const Wrench& wrench) {
    apply(bodies_[body], wrench);
  };
  if (thrusters_.hasJets()) thrusters_.renewJets(poseOf, fluidAt);
  thrusters_.push(poseOf, fluidAt, toBody);
  foils_.pushByWash(thrusters_, poseOf, fluidAt, toBody);
}

void Simulation::stepUnchecked() {
  if (thrusters_.size() + foils_.size() > 0) push();
  if (robots_) robots_->prepareStep(0, time(), time_step_);
  // 0 substeps: Bullet makes exactly one step of this length.
  bullet_.world->stepSimulation(static_cast<btScalar>(time_step_), 0);
  ++steps_;
}

std::optional<std::string> Simulation::fault() const {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (work(i).rejected > 0 || (!isSound(i) && !sample(bodies_[i]).isFinite()))
      return notFinite(file_, bodies_[i].name, time());
  return std::nullopt;
}

void Simulation::setRegions(const Scene& scene) {
  std::vector<FluidRegion> regions = regionsOf(scene);
  if (regions.size() != regions_.size())
    raiseInputError(scene.file.string(), "it has ", regions.size(),
                    " waters and regions, the world ", regions_.size(), "; must be as many");
  for (std::size_t i = 0; i < regions.size(); ++i) fluid_.setRegion(regions_[i], regions[i]);
  fluids_ = std::move(regions);
}

btMultiBody& Simulation::multiBodyOf(const WorldBody& link) const {
  return robots_->multiBody(*link.link);
}

btRigidBody& Simulation::find(const std::string& name) const {
  const auto found = std::find_if(bodies_.begin(), bodies_.end(),
                                  [&](const WorldBody& body) { return body.name == name; });
  if (found == bodies_.end() || !found->body)
    raiseInputError(file_, "there is no rigid body \"", name, "\"");
  return *found->body;
}

std::shared_ptr<const FluidBody> Simulation::findFluidBody(const std::string& name) const {
  const auto found = std::find_if(bodies_.begin(), bodies_.end(), [&](const WorldBody& body) {
    return body.fluid_body && body.fluid_body->name == name;
  });
  return found == bodies_.end() ? nullptr : found->fluid_body;
}

MotionSample Simulation::sample(const WorldBody& of) const {
  if (steps_ == 0 && of.is_at_start) return of.start;
  MotionSample now;
  if (of.link) {
    now = robots_->sample(*of.link);
  } else {
    const btTransform& pose = of.body->getWorldTransform();
    now.position = toVector3(pose.getOrigin());
    now.orientation = toQuaternion(pose.getRotation()) * of.to_B;
    now.twist = {toVector3(of.body->getAngularVelocity()), toVector3(of.body->getLinearVelocity())};
  }
  now.time = time();
  return now;
}

std::vector<MotionSample> Simulation::sample() const {
  std::vector<MotionSample> samples;
  for (const WorldBody& body : bodies_) samples.push_back(sample(body));
  return samples;
}

AmbientCounters Simulation::work(std::size_t body) const {
  const auto& immersed = bodies_.at(body).immersed;
  return immersed ? immersed->counters() : AmbientCounters{};
}

void Simulation::readWrench(std::size_t body, bool is_read) {
  if (const auto& immersed = bodies_.at(body).immersed) immersed->readWrench(is_read);
}

FluidWrench Simulation::wrench(std::size_t body) const {
  const auto& immersed = bodies_.at(body).immersed;
  return immersed ? immersed->wrench() : FluidWrench{};
}

WetState Simulation::wet(std::size_t body) const {
  const auto& immersed = bodies_.at(body).immersed;
  return immersed ? immersed->wet() : WetState{};
}

std::vector<HoldWater> Simulation::holds(std::size_t body) const {
  const auto& immersed = bodies_.at(body).immersed;
  return immersed ? immersed->holds() : std::vector<HoldWater>{};
}

const Immersed& Simulation::vessel(std::size_t body) const {
  const WorldBody& of = bodies_.at(body);
  if (!of.immersed) throw std::invalid_argument("no fluid acts on body '" + of.name + "'");
  return *of.immersed;
}

void Simulation::apply(const WorldBody& to, const Wrench& wrench) {
  const btVector3 force = toBullet(wrench.force), torque = toBullet(wrench.torque);
  if (!to.link) {
    to.body->applyCentralForce(force);
    to.body->applyTorque(torque);
    return;
  }
  btMultiBody& body = multiBodyOf(to);
  const int number = to.linkNumber();
  if (number < 0) {
    body.addBaseForce(force);
    body.addBaseTorque(torque);
  } else {
    body.addLinkForce(number, force);
    body.addLinkTorque(number, torque);
  }
}

void Simulation::applyForce(std::size_t body, const Vector3& force, const Vector3& point) {
  const WorldBody& of = bodies_.at(body);
  apply(of, Wrench::ofForceAt(force, point - sample(of).position));
}

void Simulation::applyTorque(std::size_t body, const Vector3& torque) {
  apply(bodies_.at(body), {torque, Vector3::Zero()});
}

btRigidBody& Simulation::rigidBody(std::size_t body) {
  WorldBody& of = bodies_.at(body);
  if (of.link)
    throw std::invalid_argument("body \"" + of.name + "\" is a link; its robot can be set");
  of.is_at_start = false;
  return *of.body;
}

void Simulation::setPose(std::size_t body, const Vector3& position, const Quaternion& orientation) {
  btRigidBody& moved = rigidBody(body);
  const Quaternion to_W(Matrix3(orientation.normalized() * bodies_[body].R_SB));
  moved.setCenterOfMassTransform(btTransform(toBullet(to_W), toBullet(position)));
}

void Simulation::setTwist(std::size_t body, const Twist& twist_W) {
  btRigidBody& moved = rigidBody(body);
  moved.setAngularVelocity(toBullet(twist_W.angular));
  moved.setLinearVelocity(toBullet(twist_W.linear));
}

SceneRobot& Simulation::changedRobot(std::size_t index) {
  for (WorldBody& body : bodies_)
    if (body.link && body.link->robot == index) body.is_at_start = false;
  return robot(index);
}

void Simulation::setMedium(std::size_t body, const Medium& medium) {
  const WorldBody& of = bodies_.at(body);
  try {
    if (!of.immersed) throw std::invalid_argument("it is in no fluid");
    of.immersed->setMedium(medium);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("body \"" + of.name + "\": " + error.what());
  }
}

std::string Simulation::saveState() const {
  const std::vector<ThrusterState>& thrusters = thrusters_.states();
  std::string bytes;
  const auto append = [&bytes](const auto* from, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(from), count * sizeof *from);
  };
  append(&steps_, 1);
  append(thrusters.data(), thrusters.size());
  const std::vector<double> angles = foils_.angles();
  append(angles.data(), angles.size());
  return bytes + encodeState(fluid_.save());
}

void Simulation::restoreState(std::string_view bytes) {
  const std::string source = "saved state";
  std::vector<ThrusterState> thrusters(thrusters_.size());
  std::vector<double> angles(foils_.size());
  long long steps = 0;
  std::size_t head = 0;
  const auto take = [&](auto* to, std::size_t count) {
    const std::size_t size = count * sizeof *to;
    if (bytes.size() < head + size) throw std::runtime_error(source + ": is cut short");
    if (size > 0) std::memcpy(to, bytes.data() + head, size);
    head += size;
  };
  take(&steps, 1);
  take(thrusters.data(), thrusters.size());
  take(angles.data(), angles.size());
  if (steps < 0) throw std::runtime_error(source + ": is damaged: its steps are below 0");
  for (const ThrusterState& thruster : thrusters)
    if (!thruster.isFinite()) throw std::runtime_error(source + ": a thrust is not finite");
  for (const double angle : angles)
    if (!std::isfinite(angle)) throw std::runtime_error(source + ": an angle is not finite");
  const auto lookup = [this](const std::string& name) { return findFluidBody(name); };
  WorldState state = decodeState(bytes.substr(head), source, lookup);
  setFunctions(state, own_law_, own_flight_);
  fluid_.restore(state);
  thrusters_.setStates(thrusters);
  foils_.setAngles(angles);
  steps_ = steps;
}

void Simulation::restore(const SimulationState& state) {
  fluid_.restore(state.world);
  thrusters_.setStates(state.thrusters);
  foils_.setAngles(state.foil_angles);
  steps_ = state.steps;
  for (WorldBody& body : bodies_) body.is_at_start = false;
}

}  // namespace ambient
