#include "demos/pybullet/world_fluid.h"

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <LinearMath/btIDebugDraw.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/fluid_body.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/scene/scene_parts.h"
#include "preprocess/polar/polar.h"
#include "preprocess/resistance/prepare.h"

namespace ambient::pybullet {
namespace {

// Helper that the server has for one call. The server's setGuiHelper() calls
// createPhysicsDebugDrawer() with its world, and no other function.
struct Probe final : SilentHelper {
  btDiscreteDynamicsWorld* world = nullptr;
  void createPhysicsDebugDrawer(btDiscreteDynamicsWorld* its) override { world = its; }
};

// Returns the helper of a server with a window; null: the server has no window. The helper has
// given the world a debug drawer, whose first member is the pointer to the helper.
GuiHelper* helperOf(btIDebugDraw* drawer) {
  if (!drawer || !std::strstr(typeid(*drawer).name(), "MultithreadedDebugDrawer")) return nullptr;
  GuiHelper* helper = nullptr;
  // NOLINTNEXTLINE(bugprone-sizeof-expression): the bytes of a pointer
  std::memcpy(&helper, reinterpret_cast<const char*>(drawer) + sizeof(void*), sizeof helper);
  return helper;
}

}  // namespace

btDiscreteDynamicsWorld* findWorld(Server& server, Client& client) {
  Probe probe;
  server.setGuiHelper(&probe);
  if (!probe.world) {
    server.setGuiHelper(nullptr);
  } else if (GuiHelper* helper = helperOf(probe.world->getDebugDrawer())) {
    server.setGuiHelper(helper);
  } else {
    // Without a window, connect() makes the client give the server PyBullet's own DummyGUIHelper,
    // which lives as long as the server.
    client.connect();
  }
  return probe.world;
}

bool hasOurLayout(btDynamicsWorld& world) {
  const btContactSolverInfo& info = world.getSolverInfo();
  return info.m_maxErrorReduction == 20 && info.m_restitution == 0 &&
         info.m_maxGyroscopicForce == 100;
}

bool hasOurLayout(const btMultiBody& multi_body) {
  int freedoms = 0, positions = 0;
  for (int i = 0; i < multi_body.getNumLinks(); ++i) {
    freedoms += multi_body.getLink(i).m_dofCount;
    positions += multi_body.getLink(i).m_posVarCount;
  }
  return multi_body.getNumDofs() == freedoms && multi_body.getNumPosVars() == positions &&
         multi_body.getUserIndex2() >= 0 && multi_body.getMaxAppliedImpulse() == 1000 &&
         multi_body.getCompanionId() >= -1;
}

namespace {

Matrix3 readRotation(const Command& command) {
  if (!command.values.contains("rotation")) return Matrix3::Identity();
  const auto q = command.values.at("rotation").get<std::vector<double>>();
  const Quaternion rotation(q[3], q[0], q[1], q[2]);
  if (!(rotation.norm() > 0)) command.fail("rotation is x,y,z,w of a quaternion, not all 0");
  return rotation.normalized().toRotationMatrix();
}

// Scales a body to a volume about its centre of volume.
void scaleTo(double volume, FluidBody& body, FrameOffset& frame) {
  if (!(body.volume > 0))
    throw std::invalid_argument("body: '" + body.name +
                                "' has no volume, so that it cannot have a density");
  const double factor = portable::cbrt(volume / body.volume);
  frame.translation += (1 - factor) * (frame.rotation * body.centre_of_volume);
  body = scaled(body, factor);
}

const char* const kOurs = "bullet_ambient: ";  // begins sentences
const char* const kHulls = "hulls";            // entry of printed_: it was said
constexpr std::size_t kKeptSentences = 100;
const char* const kOtherLayout =
    "this PyBullet has other layouts than the plugin, which is for 3.1.7 and later in double";

btMultiBodyDynamicsWorld& requireLayout(btMultiBodyDynamicsWorld& world) {
  if (!hasOurLayout(world)) throw std::invalid_argument(kOtherLayout);
  return world;
}

// Returns the name of an object in reports, such as "PyBullet 3, link 2 elbow": PyBullet's numbers
// and the name in the URDF file.
std::string nameOf(const btCollisionObject& object) {
  const auto* collider = btMultiBodyLinkCollider::upcast(&object);
  if (!collider) return "PyBullet " + std::to_string(object.getUserIndex2());
  const btMultiBody& multi_body = *collider->m_multiBody;
  const int link = collider->m_link;
  const char* given = link < 0 ? multi_body.getBaseName() : multi_body.getLink(link).m_linkName;
  std::string name = "PyBullet " + std::to_string(multi_body.getUserIndex2());
  if (link >= 0) name += ", link " + std::to_string(link);
  return given ? name + " " + given : name;
}

bool isOfParts(const btCollisionObject& object) {
  const btCollisionShape& shape = *object.getCollisionShape();
  return shape.isCompound() && static_cast<const btCompoundShape&>(shape).getNumChildShapes() > 1;
}

// Returns why a state that is saved now may not be restored bit for bit; null: it is.
const char* hindranceOf(const btDispatcherInfo& info, btDispatcher& dispatcher) {
  const char* found = nullptr;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& touch = *dispatcher.getManifoldByIndexInternal(i);
    if (touch.getNumContacts() == 0) continue;
    if (!info.m_deterministicOverlappingPairs)
      return "bodies touch each other where a state is saved: after restore() they do not move on "
             "bit for bit, unless setPhysicsEngineParameter(deterministicOverlappingPairs=1) was "
             "called";
    if (isOfParts(*touch.getBody0()) || isOfParts(*touch.getBody1()))
      found =
          "a body of several collision shapes touches something where a state is saved: after "
          "restore() it may not move on bit for bit, as Bullet alone knows in which order these "
          "shapes touch";
  }
  return found;
}

// True for a convex hull, also one in a compound of its own.
bool isLoneHull(const btCollisionShape& shape) {
  if (!shape.isCompound()) return shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE;
  const auto& compound = static_cast<const btCompoundShape&>(shape);
  return compound.getNumChildShapes() == 1 && isLoneHull(*compound.getChildShape(0));
}

}  // namespace

WorldFluid::WorldFluid(btMultiBodyDynamicsWorld& world, std::set<std::string>& printed,
                       std::function<void()> at_end)
    : world_(requireLayout(world)),
      printed_(printed),
      end_(world, std::move(at_end)),
      fluid_(world, SolverOwner::kAsksWorld) {
  fluid_.setNaming(nameOf);
  fluid_.setReport([this](const std::string& sentence) { say(sentence); });
}

double WorldFluid::timeStep() const { return world_.getSolverInfo().m_timeStep; }

void WorldFluid::say(const std::string& sentence) {
  if (printed_.insert(sentence).second) std::fprintf(stderr, "%s\n", sentence.c_str());
  if (said_.size() < kKeptSentences) said_.push_back(sentence);
}

void WorldFluid::sayOnce(const std::string& sentence) {
  if (std::find(said_.begin(), said_.end(), sentence) == said_.end()) say(sentence);
}

void WorldFluid::prepare(const Settings& settings, bool has_news) {
  if (has_news) checkLayouts();
  fluid_.refit();
  if (!has_news) return;
  // Entries that the filters have made in a substep: their bodies may have been destroyed since.
  new_bodies_.clear();
  new_links_.clear();
  if (std::exchange(was_added_, true)) {
    fluid_.addLaterBodies();
  } else {
    addAll(settings);
  }
  storeHandles(settings.shapes);
  sayHulls();
}

// PyBullet replaces a mesh in <collision> by its convex hull, and keeps no trace of the mesh.
void WorldFluid::sayHulls() {
  for (const auto& [key, multi_body] : new_links_) {
    const auto* collider = find(key.first, key.second).collider;
    if (!collider || members_.count(key) == 0 || !isLoneHull(*collider->getCollisionShape()))
      continue;
    if (!printed_.insert(kHulls).second) return;
    return say(
        std::string(kOurs) + "body '" + nameOf(*collider) +
        "' displaces the convex hull that PyBullet has made of its mesh or cylinder, without "
        "hollows and gaps; Fluid.body() gives a link another fluid body");
  }
}

void WorldFluid::checkLayouts() const {
  for (int i = 0; i < world_.getNumMultibodies(); ++i)
    if (!hasOurLayout(*world_.getMultiBody(i))) throw std::invalid_argument(kOtherLayout);
}

bool WorldFluid::isWanted(int body, int link) const {
  return excluded_.count({body, link}) == 0 && excluded_.count({body, kAllLinks}) == 0;
}

void WorldFluid::addAll(const Settings& settings) {
  AttachSettings attach;
  attach.flow = settings.flow;
  attach.later_bodies = true;
  attach.filter = [this](const btRigidBody& body) {
    const Key key{body.getUserIndex2(), -1};
    if (!isWanted(key.first, key.second)) return false;
    new_bodies_.emplace_back(key, &body);
    return true;
  };
  attach.filter_link = [this](const btMultiBody& multi_body, int link) {
    const Key key{multi_body.getUserIndex2(), link};
    if (!isWanted(key.first, key.second)) return false;
    new_links_.emplace_back(key, &multi_body);
    return true;
  };
  for (const auto& refusal : fluid_.addAll(settings.shapes, Medium{}, std::move(attach)).refused)
    say(kOurs + refusal.reason);
}

// Stores the handles of new members under their numbers. PyBullet reuses only numbers of removed
// bodies, whose handles forget() has erased.
void WorldFluid::storeHandles(const FluidBodyCache& shapes) {
  for (const auto& [key, body] : new_bodies_)
    if (const auto member = fluid_.find(*body)) store(key, *member, shapes);
  for (const auto& [key, multi_body] : new_links_)
    if (const auto member = fluid_.find(*multi_body, key.second)) store(key, *member, shapes);
}

// The cache has printed what it said when it made the fluid body, for this client or another one.
void WorldFluid::store(const Key& key, const Immersed& member, const FluidBodyCache& shapes) {
  members_.insert_or_assign(key, member);
  for (const std::string& line : shapes.said(*member.fluidBody())) {
    printed_.insert(kOurs + line);
    sayOnce(kOurs + line);
  }
}

WorldFluid::Found WorldFluid::find(int body, int link) const {
  Found found;
  for (int i = 0; i < world_.getNumMultibodies(); ++i) {
    btMultiBody& multi_body = *world_.getMultiBody(i);
    if (multi_body.getUserIndex2() != body || link >= multi_body.getNumLinks()) continue;
    found.multi_body = &multi_body;
    found.collider = link < 0 ? multi_body.getBaseCollider() : multi_body.getLinkCollider(link);
    found.mass = link < 0 ? multi_body.getBaseMass() : multi_body.getLinkMass(link);
    return found;
  }
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; link < 0 && i < objects.size(); ++i) {
    found.rigid = btRigidBody::upcast(objects[i]);
    if (!found.rigid || found.rigid->getUserIndex2() != body) continue;
    found.collider = found.rigid;
    found.mass = found.rigid->getMass();
    return found;
  }
  throw std::invalid_argument("there is no body " + std::to_string(body) + " with link " +
                              std::to_string(link));
}

void WorldFluid::choose(int body, int link, const ChosenBody& chosen, FluidBodyCache& shapes) {
  const auto before = chosen_.find({body, link});
  if (before != chosen_.end() && before->second.first.flow.foils)
    throw std::invalid_argument("body: it has foils; choose it before them");
  attach(find(body, link), {body, link}, chosen, shapes);
}

void WorldFluid::giveFoils(int body, int link, std::shared_ptr<const Foils> foils,
                           const Settings& settings) {
  const auto before = chosen_.find({body, link});
  ChosenBody chosen;
  chosen.flow = settings.flow;
  if (before != chosen_.end()) chosen = before->second.first;
  chosen.flow.foils = std::move(foils);
  attach(find(body, link), {body, link}, chosen, settings.shapes);
}

void WorldFluid::attach(const Found& found, const Key& key, ChosenBody chosen,
                        FluidBodyCache& shapes) {
  std::shared_ptr<const FluidBody> made;
  if (chosen.file.empty()) {
    const btCollisionShape* shape = found.collider ? found.collider->getCollisionShape() : nullptr;
    if (!shape) throw std::invalid_argument("body: it has no collision shape; choose a file");
    made = shapes.fluidBody(*shape);
  }
  AttachDef def = definitionOf(chosen, std::move(made), found.mass);
  if (found.collider) def.name = nameOf(*found.collider);
  checkFlow(*def.fluid_body, def.flow);
  const FrameOffset frame = def.fluid_frame;
  exclude(key.first, key.second);  // from what is added by its collision shape
  const Immersed member = found.rigid ? fluid_.add(*found.rigid, std::move(def))
                                      : fluid_.add(*found.multi_body, key.second, std::move(def));
  store(key, member, shapes);
  chosen_.insert_or_assign(key, std::pair(std::move(chosen), frame));
}

FrameOffset WorldFluid::frameOf(int body, int link) const {
  const auto chosen = chosen_.find({body, link});
  return chosen == chosen_.end() ? FrameOffset() : chosen->second.second;
}

MotionSample WorldFluid::motionInF(int body, int link) const {
  const Found found = find(body, link);
  btTransform pose;
  Twist twist;
  if (found.rigid) {
    pose = found.rigid->getWorldTransform();
    twist = {toVector3(found.rigid->getAngularVelocity()),
             toVector3(found.rigid->getLinearVelocity())};
  } else if (link < 0) {
    pose = found.multi_body->getBaseWorldTransform();
    twist = {toVector3(found.multi_body->getBaseOmega()),
             toVector3(found.multi_body->getBaseVel())};
  } else {
    pose = found.multi_body->getLink(link).m_cachedWorldTransform;
    std::vector<btVector3> angular(static_cast<std::size_t>(found.multi_body->getNumLinks()) + 1),
        linear(angular.size());
    found.multi_body->compTreeLinkVelocities(angular.data(), linear.data());  // in link frames
    const auto index = static_cast<std::size_t>(link) + 1;
    twist = {toVector3(pose.getBasis() * angular[index]),
             toVector3(pose.getBasis() * linear[index])};
  }
  MotionSample sample;
  sample.position = toVector3(pose.getOrigin());
  sample.orientation = toQuaternion(pose.getRotation()) * Quaternion(frameOf(body, link).rotation);
  sample.twist = twist;
  return sample;
}

void WorldFluid::push(int body, int link, const Wrench& wrench, Push& last) const {
  const Found found = find(body, link);
  btMultiBody* const tree = found.multi_body;
  const auto force = [&] {
    if (found.rigid) return found.rigid->getTotalForce();
    return link < 0 ? tree->getBaseForce() : tree->getLinkForce(link);
  };
  const auto torque = [&] {
    if (found.rigid) return found.rigid->getTotalTorque();
    return link < 0 ? tree->getBaseTorque() : tree->getLinkTorque(link);
  };
  Wrench change = wrench;
  if (force() == last.force && torque() == last.torque) change -= last.wrench;
  const btVector3 f = toBullet(change.force), t = toBullet(change.torque);
  if (found.rigid) {
    found.rigid->applyCentralForce(f);
    found.rigid->applyTorque(t);
  } else if (link < 0) {
    tree->addBaseForce(f);
    tree->addBaseTorque(t);
  } else {
    tree->addLinkForce(link, f);
    tree->addLinkTorque(link, t);
  }
  last = {wrench, force(), torque()};
}

void WorldFluid::check(const FlowSettings& flow, FluidBodyCache& shapes) const {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btCollisionObject& object = *objects[i];
    const auto* link = btMultiBodyLinkCollider::upcast(&object);
    const int body = link ? link->m_multiBody->getUserIndex2() : object.getUserIndex2();
    if (object.isStaticOrKinematicObject() || !isWanted(body, link ? link->m_link : -1)) continue;
    std::shared_ptr<const FluidBody> made;
    try {
      made = shapes.fluidBody(*object.getCollisionShape());
    } catch (const std::exception&) {
      continue;  // said when it is added
    }
    try {
      checkFlow(*made, flow);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("settings: body '" + nameOf(object) + "': " + error.what());
    }
  }
}

void WorldFluid::forget(int body) {
  exclude(body, kAllLinks);
  // Excluding holds for this body, not for a later one with its number.
  const auto begin = excluded_.lower_bound({body, kAllLinks});
  excluded_.erase(begin, excluded_.lower_bound({body + 1, kAllLinks}));
}

void WorldFluid::exclude(int body, int link) {
  excluded_.insert({body, link});
  for (auto it = members_.lower_bound({body, kAllLinks});
       it != members_.end() && it->first.first == body;) {
    const bool is_meant = link == kAllLinks || it->first.second == link;
    if (is_meant) it->second.remove();
    if (is_meant) chosen_.erase(it->first);
    it = is_meant ? members_.erase(it) : std::next(it);
  }
}

Immersed WorldFluid::require(int body, int link) const {
  const auto found = members_.find({body, link});
  if (found != members_.end()) return found->second;
  throw std::invalid_argument("body " + std::to_string(body) + ", link " + std::to_string(link) +
                              " is not in the fluid");
}

const btMultiBody& WorldFluid::multiBody(int body) const {
  for (int i = 0; i < world_.getNumMultibodies(); ++i)
    if (world_.getMultiBody(i)->getUserIndex2() == body) return *world_.getMultiBody(i);
  throw std::invalid_argument("there is no multibody " + std::to_string(body));
}

std::size_t WorldFluid::save() {
  if (const char* why = hindranceOf(world_.getDispatchInfo(), *world_.getDispatcher()))
    sayOnce(std::string(kOurs) + why);
  states_.push_back(fluid_.save());
  return states_.size() - 1;
}

void WorldFluid::restore(std::size_t state) {
  if (state >= states_.size())
    throw std::invalid_argument("this world has " + std::to_string(states_.size()) +
                                " saved states, and no state " + std::to_string(state));
  fluid_.restore(states_[state]);
}

ChosenBody readChosenBody(const Command& command, const FlowSettings& flow) {
  const nlohmann::json& values = command.values;
  ChosenBody chosen;
  chosen.flow = flow;
  chosen.file = values.value("file", "");
  chosen.fluid_frame = {readRotation(command), vectorOr(values, "origin", Vector3::Zero())};
  if (chosen.file.empty() && !chosen.fluid_frame.isIdentity())
    command.fail("origin and rotation are those of a file");
  chosen.density = values.value("density", 0.0);
  chosen.drag = vectorOr(values, "drag", Vector3::Zero());
  chosen.medium = values.value("medium", "");
  chosen.flow.law = lawOr(values, flow.law);
  chosen.flow.roughness = values.value("roughness", flow.roughness);
  return chosen;
}

AttachDef definitionOf(const ChosenBody& chosen, std::shared_ptr<const FluidBody> shape,
                       double mass) {
  AttachDef def;
  def.flow = chosen.flow;
  def.fluid_frame = chosen.fluid_frame;
  if (chosen.medium == "water") def.medium = water();
  if (chosen.medium == "air") def.medium = air();
  def.fluid_body = chosen.file.empty()
                       ? std::move(shape)
                       : std::make_shared<const FluidBody>(readPrepared(chosen.file));
  if (chosen.density == 0 && chosen.drag.isZero(0)) return def;
  FluidBody own = *def.fluid_body;
  if (chosen.density > 0) scaleTo(mass / chosen.density, own, def.fluid_frame);
  if (!chosen.drag.isZero(0)) setMeasuredDrag(chosen.drag, own);
  def.fluid_body = std::make_shared<const FluidBody>(std::move(own));
  return def;
}

}  // namespace ambient::pybullet
