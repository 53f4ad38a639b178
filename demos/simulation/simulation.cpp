#include "demos/simulation/simulation.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/ambient_solver.h"
#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/bullet/world_state.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "demos/rivals/rival_laws.h"
#include "demos/scene/scene_water.h"
#include "demos/simulation/collision_shape.h"
#include "demos/simulation/joint.h"

namespace ambient {

/// One body in the world. Bullet's body frame B has its origin at the centre of mass and principal
/// axes; S is the shape's frame.
struct WorldBody {
  std::string name;
  MotionSample start;
  Matrix3 R_SB = Matrix3::Identity();  // B's axes to S's
  CollisionShape shape;
  std::unique_ptr<btRigidBody> body;
  std::shared_ptr<const FluidBody> fluid_body;
  bool is_ambient = false;
};

namespace {

MotionSample startOf(const BodyDef& def) {
  MotionSample start;
  start.position = def.position;
  start.orientation = def.orientation;
  start.twist = {def.angular_velocity, def.linear_velocity};
  return start;
}

btTransform toBulletPose(const Matrix3& rotation, const Vector3& translation) {
  return btTransform(toBulletMatrix(rotation), toBullet(translation));
}

WorldBody makeWorldBody(const BodyDef& def, const PreparedBody& prepared) {
  WorldBody made;
  made.name = def.name;
  made.fluid_body = prepared.fluid_body;
  made.start = startOf(def);
  PrincipalFrame principal;
  if (prepared.mass > 0) principal = findPrincipalFrame(prepared.inertia);
  made.R_SB = principal.rotation;
  const Matrix3 R_BS = made.R_SB.transpose();
  made.shape = makeCollisionShape(def, prepared,
                                  toBulletPose(R_BS, Vector3(R_BS * -prepared.centre_of_mass)));

  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(prepared.mass), nullptr,
                                                made.shape.root(), toBullet(principal.moments));
  info.m_startWorldTransform =
      toBulletPose(Matrix3(def.orientation.toRotationMatrix() * made.R_SB), def.position);
  info.m_restitution = static_cast<btScalar>(def.restitution);
  info.m_friction = static_cast<btScalar>(def.friction);
  made.body = std::make_unique<btRigidBody>(info);
  made.body->setLinearVelocity(toBullet(def.linear_velocity));
  made.body->setAngularVelocity(toBullet(def.angular_velocity));
  // A body that hovers or glides slowly must not be put to sleep.
  made.body->setActivationState(DISABLE_DEACTIVATION);
  return made;
}

/// That of a rival model; empty: this library's own.
LoadLaw loadLawOf(const Scene& scene) {
  if (scene.model == FluidModel::kUwrbd) return linearDrag(scene.linear_drag_speed);
  if (scene.model == FluidModel::kGwtf) return windwardFlux();
  return nullptr;
}

AttachDef makeAttachDef(const Scene& scene, const BodyDef& def, const PreparedBody& prepared,
                        const Matrix3& R_SB) {
  AttachDef attach;
  attach.fluid_body = prepared.fluid_body;
  attach.medium = scene.medium;
  if (def.fluid_density) attach.medium.density = *def.fluid_density;
  attach.flow = def.flow;
  attach.flow.own_law = loadLawOf(scene);
  attach.wave_damping = def.wave_damping;
  attach.flight = scene.flight;
  attach.fluid_frame.rotation = R_SB.transpose();
  attach.fluid_frame.translation =
      R_SB.transpose() * (prepared.fluid_origin - prepared.centre_of_mass);
  return attach;
}

[[noreturn]] void throwNotFinite(const std::string& body, double time) {
  std::ostringstream text;
  text << "body \"" << body << "\": its state is not finite at t = " << time
       << " s; a smaller time_step may help";
  throw std::runtime_error(text.str());
}

}  // namespace

struct Simulation::World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  AmbientRegistry registry;
  AmbientSolver<btSequentialImpulseConstraintSolver> solver{registry};
  AmbientAction action{registry};
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<WorldBody> bodies;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  std::string report;
  double time_step = 0;
  long long steps = 0;

  ~World() {
    world.removeAction(&action);
    for (const auto& joint : joints) world.removeConstraint(joint.get());
    for (WorldBody& body : bodies) {
      registry.detach(*body.body);
      world.removeRigidBody(body.body.get());
    }
  }

  void add(const Scene& scene, const BodyDef& def, const PreparedBody& prepared);
  void add(const JointDef& def);
  btRigidBody& find(const std::string& name) const;
  std::shared_ptr<const FluidBody> findFluidBody(const std::string& name) const;
  MotionSample sample(const WorldBody& of) const;
};

void Simulation::World::add(const Scene& scene, const BodyDef& def, const PreparedBody& prepared) {
  bodies.push_back(makeWorldBody(def, prepared));
  WorldBody& added = bodies.back();
  world.addRigidBody(added.body.get());
  if (scene.model == FluidModel::kVacuum || prepared.mass == 0 || !prepared.fluid_body) return;
  try {
    registry.attach(world, *added.body, makeAttachDef(scene, def, prepared, added.R_SB));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("body \"" + def.name + "\": " + error.what());
  }
  added.is_ambient = true;
}

btRigidBody& Simulation::World::find(const std::string& name) const {
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const WorldBody& body) { return body.name == name; });
  return *found->body;
}

std::shared_ptr<const FluidBody> Simulation::World::findFluidBody(const std::string& name) const {
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const WorldBody& body) {
    return body.fluid_body && body.fluid_body->name == name;
  });
  return found == bodies.end() ? nullptr : found->fluid_body;
}

void Simulation::World::add(const JointDef& def) {
  btRigidBody* second = def.bodies.size() > 1 ? &find(def.bodies[1]) : nullptr;
  joints.push_back(makeJoint(def, find(def.bodies[0]), second));
  constexpr bool kWithoutCollisions = true;
  world.addConstraint(joints.back().get(), kWithoutCollisions);
}

MotionSample Simulation::World::sample(const WorldBody& of) const {
  if (steps == 0) return of.start;
  MotionSample now;
  now.time = static_cast<double>(steps) * time_step;
  const btTransform& pose = of.body->getWorldTransform();
  now.position = toVector3(pose.getOrigin());
  now.orientation = toQuaternion(pose.getRotation()) * Quaternion(Matrix3(of.R_SB.transpose()));
  now.twist = {toVector3(of.body->getAngularVelocity()), toVector3(of.body->getLinearVelocity())};
  return now;
}

Simulation::Simulation(const Scene& scene, const std::vector<PreparedBody>& bodies)
    : world_(std::make_unique<World>()) {
  World& w = *world_;
  w.time_step = scene.time_step;
  w.registry.setReport([&w](const std::string& sentence) { w.report = sentence; });
  w.world.setGravity(toBullet(scene.gravity));
  w.world.addAction(&w.action);
  for (FluidRegion& region : makeRegions(scene)) w.registry.addRegion(std::move(region));
  for (std::size_t i = 0; i < bodies.size(); ++i) w.add(scene, scene.bodies[i], bodies[i]);
  for (const JointDef& joint : scene.joints) w.add(joint);
}

Simulation::~Simulation() = default;

void Simulation::step() {
  World& w = *world_;
  // No substeps: exactly one step of this length.
  w.world.stepSimulation(static_cast<btScalar>(w.time_step), 0);
  ++w.steps;
  for (const WorldBody& body : w.bodies) {
    const bool rejected = body.is_ambient && w.registry.counters(*body.body).rejected > 0;
    if (rejected || !w.sample(body).isFinite()) throwNotFinite(body.name, time());
  }
}

double Simulation::time() const { return static_cast<double>(world_->steps) * world_->time_step; }

std::vector<MotionSample> Simulation::sample() const {
  std::vector<MotionSample> samples;
  for (const WorldBody& body : world_->bodies) samples.push_back(world_->sample(body));
  return samples;
}

void Simulation::applyForce(std::size_t body, const Vector3& force, const Vector3& point) {
  btRigidBody& of = *world_->bodies.at(body).body;
  of.applyForce(toBullet(force), toBullet(point) - of.getCenterOfMassPosition());
}

void Simulation::applyTorque(std::size_t body, const Vector3& torque) {
  world_->bodies.at(body).body->applyTorque(toBullet(torque));
}

void Simulation::setMedium(std::size_t body, const Medium& medium) {
  const WorldBody& of = world_->bodies.at(body);
  try {
    world_->registry.setMedium(*of.body, medium);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("body \"" + of.name + "\": " + error.what());
  }
}

std::string Simulation::saveState() const {
  std::string bytes(sizeof world_->steps, '\0');
  std::memcpy(bytes.data(), &world_->steps, sizeof world_->steps);
  return bytes + encodeState(ambient::saveState(world_->world, world_->registry));
}

void Simulation::restoreState(std::string_view bytes) {
  World& w = *world_;
  const std::string source = "saved state";
  if (bytes.size() < sizeof w.steps) throw std::runtime_error(source + ": is cut short");
  long long steps = 0;
  std::memcpy(&steps, bytes.data(), sizeof steps);
  if (steps < 0) throw std::runtime_error(source + ": is damaged: its steps are below 0");
  const auto lookup = [&w](const std::string& name) { return w.findFluidBody(name); };
  ambient::restoreState(decodeState(bytes.substr(sizeof steps), source, lookup), w.world,
                        w.registry);
  w.steps = steps;
}

const std::string& Simulation::warning() const { return world_->report; }

FlightWork Simulation::work(std::size_t body) const {
  const WorldBody& of = world_->bodies.at(body);
  if (!of.is_ambient) return {};
  const AmbientCounters counters = world_->registry.counters(*of.body);
  return {counters.substeps, counters.load_evaluations, counters.guarded, counters.coarse};
}

}  // namespace ambient
