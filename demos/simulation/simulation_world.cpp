#include "demos/simulation/simulation_world.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "demos/rivals/rival_laws.h"
#include "demos/scene/scene_water.h"
#include "demos/simulation/joint.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
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
  // Bullet would put a body that hovers or glides slowly to sleep.
  made.body->setActivationState(DISABLE_DEACTIVATION);
  return made;
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

/// Bullet's number of a link: -1 is the base.
int linkNumber(const WorldBody& of) { return static_cast<int>(of.link->link) - 1; }

WorldBody makeWorldLink(const BodyDef& def, const PreparedBody& prepared, const Robot& robot) {
  WorldBody made;
  made.name = def.name;
  made.link = def.link;
  made.fluid_body = prepared.fluid_body;
  made.start = startOf(def);
  made.R_SB = robot.linkInBody(linkNumber(made)).linear().transpose();
  return made;
}

BulletWorld makeBulletWorld(bool takes_robots, btCollisionDispatcher& dispatcher,
                            btBroadphaseInterface& broadphase,
                            btCollisionConfiguration& configuration) {
  BulletWorld made;
  if (takes_robots) {
    auto solver = std::make_unique<btMultiBodyConstraintSolver>();
    auto world = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher, &broadphase, solver.get(),
                                                            &configuration);
    made.multi_body_world = world.get();
    made.solver = std::move(solver);
    made.world = std::move(world);
  } else {
    auto solver = std::make_unique<btSequentialImpulseConstraintSolver>();
    made.world = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, solver.get(),
                                                           &configuration);
    made.solver = std::move(solver);
  }
  return made;
}

[[noreturn]] void throwNotFinite(const std::string& scene, const std::string& body, double time) {
  std::ostringstream text;
  text << scene << ": body \"" << body << "\": its state is not finite at t = " << time
       << " s; a smaller time_step may help";
  throw std::runtime_error(text.str());
}

}  // namespace

SimulationWorld::SimulationWorld(const Scene& scene, const std::vector<PreparedBody>& prepared,
                                 bool takes_robots)
    : bullet(makeBulletWorld(takes_robots || !scene.robots.empty(), dispatcher, broadphase,
                             configuration)),
      fluid(*bullet.world),
      own_law(loadLawOf(scene)),
      time_step(scene.time_step),
      file(scene.file.string()) {
  fluid.setReport([this](const std::string& sentence) { report = sentence; });
  bullet.world->setGravity(toBullet(scene.gravity));
  for (FluidRegion& region : makeRegions(scene)) fluid.addRegion(std::move(region));
  addRobots(scene, prepared);
  for (const JointDef& joint : scene.joints) add(joint);
}

SimulationWorld::~SimulationWorld() {
  for (const auto& joint : joints) bullet.world->removeConstraint(joint.get());
  fluid.clear();
  for (const WorldBody& body : bodies)
    if (body.body) bullet.world->removeRigidBody(body.body.get());
  robots.clear();
}

void SimulationWorld::add(const Scene& scene, const BodyDef& def, const PreparedBody& prepared) {
  if (def.link) {
    bodies.push_back(makeWorldLink(def, prepared, robots[def.link->robot]->robot()));
  } else {
    bodies.push_back(makeWorldBody(def, prepared));
    bullet.world->addRigidBody(bodies.back().body.get());
  }
  WorldBody& added = bodies.back();
  if (scene.model == FluidModel::kVacuum || prepared.mass == 0 || !prepared.fluid_body) return;
  try {
    attach(added, makeAttachDef(scene, def, prepared, added.R_SB, own_law));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(inputMessage(file, "body \"", def.name, "\": ", error.what()));
  }
}

void SimulationWorld::attach(WorldBody& added, const AttachDef& def) {
  added.immersed = added.link ? fluid.add(multiBodyOf(added), linkNumber(added), def)
                              : fluid.add(*added.body, def);
}

// Links are the last bodies of a scene.
void SimulationWorld::addRobots(const Scene& scene, const std::vector<PreparedBody>& prepared) {
  const std::size_t had = robots.size();
  for (std::size_t i = had; i < scene.robots.size(); ++i) add(scene.robots[i]);
  // Adds all motors to the world now: restoring a saved state requires the same constraints.
  for (std::size_t i = had; i < robots.size(); ++i) robots[i]->prepareStep(time(), time_step);
  for (std::size_t i = bodies.size(); i < prepared.size(); ++i)
    add(scene, scene.bodies[i], prepared[i]);
}

void SimulationWorld::add(const RobotDef& def) {
  robots.push_back(std::make_unique<SceneRobot>(def));
  robots.back()->robot().addTo(*bullet.multi_body_world);
}

void SimulationWorld::add(const JointDef& def) {
  btRigidBody* second = def.bodies.size() > 1 ? &find(def.bodies[1]) : nullptr;
  try {
    joints.push_back(makeJoint(def, find(def.bodies[0]), second));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(inputMessage(file, error.what()));
  }
  constexpr bool kWithoutCollisions = true;
  bullet.world->addConstraint(joints.back().get(), kWithoutCollisions);
}

void SimulationWorld::step() {
  for (const auto& robot : robots) robot->prepareStep(time(), time_step);
  // 0 substeps: Bullet makes exactly one step of this length.
  bullet.world->stepSimulation(static_cast<btScalar>(time_step), 0);
  ++steps;
  for (const WorldBody& body : bodies)
    if (counters(body).rejected > 0 || !sample(body).isFinite())
      throwNotFinite(file, body.name, time());
}

btMultiBody& SimulationWorld::multiBodyOf(const WorldBody& link) const {
  return robots[link.link->robot]->robot().multiBody();
}

btRigidBody& SimulationWorld::find(const std::string& name) const {
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const WorldBody& body) { return body.name == name; });
  return *found->body;
}

std::shared_ptr<const FluidBody> SimulationWorld::findFluidBody(const std::string& name) const {
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const WorldBody& body) {
    return body.fluid_body && body.fluid_body->name == name;
  });
  return found == bodies.end() ? nullptr : found->fluid_body;
}

MotionSample SimulationWorld::sample(const WorldBody& of) const {
  if (steps == 0) return of.start;
  MotionSample now;
  if (of.link) {
    now = robots[of.link->robot]->sample(of.link->link);
  } else {
    const btTransform& pose = of.body->getWorldTransform();
    now.position = toVector3(pose.getOrigin());
    now.orientation = toQuaternion(pose.getRotation()) * Quaternion(Matrix3(of.R_SB.transpose()));
    now.twist = {toVector3(of.body->getAngularVelocity()), toVector3(of.body->getLinearVelocity())};
  }
  now.time = time();
  return now;
}

void SimulationWorld::apply(const WorldBody& to, const Wrench& wrench) {
  const btVector3 force = toBullet(wrench.force), torque = toBullet(wrench.torque);
  if (!to.link) {
    to.body->applyCentralForce(force);
    to.body->applyTorque(torque);
    return;
  }
  btMultiBody& body = multiBodyOf(to);
  const int number = linkNumber(to);
  if (number < 0) {
    body.addBaseForce(force);
    body.addBaseTorque(torque);
  } else {
    body.addLinkForce(number, force);
    body.addLinkTorque(number, torque);
  }
}

void SimulationWorld::setMedium(const WorldBody& of, const Medium& medium) {
  if (!of.immersed) throw std::invalid_argument("it is in no fluid");
  of.immersed->setMedium(medium);
}

AmbientCounters SimulationWorld::counters(const WorldBody& of) const {
  return of.immersed ? of.immersed->counters() : AmbientCounters();
}

}  // namespace ambient
