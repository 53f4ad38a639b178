#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/world/fluid_action.h"

AMBIENT_BEGIN
namespace {

int instanceOf(const btCollisionObject& object) noexcept {
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return instanceNumber(*body);
  const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(&object);
  return collider && collider->m_multiBody ? instanceNumber(*collider->m_multiBody) : -1;
}

bool isDynamic(const btRigidBody& body) {
  return !body.isStaticOrKinematicObject() && body.getInvMass() != 0;
}

bool canMove(const btMultiBody& multi_body, int link) {
  if (link < 0) return !multi_body.isBaseStaticOrKinematic() && multi_body.getBaseMass() > 0;
  return multi_body.getLinkMass(link) > 0;
}

// True for an object that a fluid can move; null is none.
bool canJoin(const btCollisionObject* object) {
  if (!object) return false;
  if (const btRigidBody* body = btRigidBody::upcast(object)) return isDynamic(*body);
  const auto* collider = btMultiBodyLinkCollider::upcast(object);
  return collider && collider->m_multiBody && canMove(*collider->m_multiBody, collider->m_link);
}

std::string nameOf(int index, const btCollisionObject& object, const AmbientBodies& bodies) {
  if (bodies.naming) {
    try {
      const std::string given = bodies.naming(object);
      if (!given.empty()) return "body '" + given + "'";
    } catch (...) {  // then by its shape
    }
  }
  const std::string name = "body " + std::to_string(index);
  const btCollisionShape* shape = object.getCollisionShape();
  return shape ? name + " (" + shape->getName() + ")" : name;
}

// Calls a function of the program's settings; what it throws is named after the function.
template <class Call>
auto callOf(const char* name, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string(name) + " threw: " + error.what());
  } catch (...) {
    throw std::runtime_error(std::string(name) + " threw something unknown");
  }
}

// PyBullet gives links without collision elements such a shape.
bool isEmpty(const btCollisionShape& shape) {
  return shape.isCompound() && static_cast<const btCompoundShape&>(shape).getNumChildShapes() == 0;
}

bool hasShape(const btCollisionObject& object) {
  return object.getCollisionShape() && !isEmpty(*object.getCollisionShape());
}

// Counts bodies that were just attached, for one report of all.
struct Tally {
  std::set<const FluidBody*> shapes;
  std::optional<AttachDef> lightest;  // for its share of what it displaces
  DisplacedMass mass;
  btVector3 gravity{0, 0, 0};  // of the world of multibodies [m/s^2]
  int light_count = 0;

  void add(int index, const AmbientBody& ambient, const AmbientTrees& trees, AttachReport& report) {
    ++report.attached;
    shapes.insert(ambient.def->fluid_body.get());
    const DisplacedMass own = displacedMass(ambient);
    if (own.isLighter()) report.light.push_back({index, own.body, own.medium});
    const auto rising = risingMass(ambient, trees, gravity);
    if (!rising) return;
    if (light_count++ > 0 && rising->body * mass.medium >= mass.body * rising->medium) return;
    lightest = *ambient.def;
    mass = *rising;
  }
};

}  // namespace

std::string AttachReport::text() const {
  std::ostringstream text;
  text << attached << " bodies attached with " << fluid_bodies << " fluid bodies, "
       << refused.size() << " refused, " << light.size() << " lighter than what they displace\n";
  for (const Refusal& refusal : refused) text << refusal.reason << '\n';
  return text.str();
}

WorldAttachment::WorldAttachment(AmbientBodies& bodies, FluidBodySource& source,
                                 const Medium& medium, AttachSettings settings)
    : bodies_(bodies), source_(source), medium_(medium), settings_(std::move(settings)) {}

bool WorldAttachment::isWanted(const btMultiBody& multi_body, int link) const {
  return !settings_.filter_link ||
         callOf("filter_link", [&] { return settings_.filter_link(multi_body, link); });
}

std::shared_ptr<const btCollisionShape> WorldAttachment::shapeOf(
    const btCollisionObject& object) const {
  // It belongs to the object.
  std::shared_ptr<const btCollisionShape> own(object.getCollisionShape(), [](const auto*) {});
  const auto* collider = btMultiBodyLinkCollider::upcast(&object);
  if (!collider) return own;
  auto all = std::make_shared<btCompoundShape>();
  const auto include = [&all](const btCollisionObject* part, const btTransform& pose) {
    if (part && hasShape(*part))
      all->addChildShape(pose, const_cast<btCollisionShape*>(part->getCollisionShape()));
  };
  const btMultiBody& body = *collider->m_multiBody;
  for (const FixedLink& carried : carriedBy(body, collider->m_link))
    if (isWanted(body, carried.link)) include(colliderOf(body, carried.link), carried.pose);
  if (all->getNumChildShapes() == 0) return own;
  include(&object, btTransform::getIdentity());
  return all;
}

bool WorldAttachment::isToAdd(const btRigidBody& body, AttachReport& report) const {
  if (!isDynamic(body)) return false;
  if (settings_.filter && !callOf("filter", [&] { return settings_.filter(body); })) return false;
  if (!bodies_.find(&body)) return true;
  ++report.attached_before;
  return false;
}

bool WorldAttachment::isToAdd(const btMultiBody& multi_body, int link, AttachReport& report) const {
  if (!canMove(multi_body, link)) {
    if (hasShape(*colliderOf(multi_body, link)) && !carrierOf(multi_body, link) &&
        isWanted(multi_body, link))
      throw std::invalid_argument(
          "it has no mass, and no fixed joint holds it to a link that has one, so that no fluid "
          "acts on it");
    return false;
  }
  if (!isWanted(multi_body, link)) return false;
  if (!bodies_.trees.find(&multi_body, link)) return true;
  ++report.attached_before;
  return false;
}

bool WorldAttachment::isToAdd(const btCollisionObject& object, AttachReport& report) const {
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return isToAdd(*body, report);
  const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(&object);
  if (!collider || !collider->m_multiBody || !multibody_world_) return false;
  return isToAdd(*collider->m_multiBody, collider->m_link, report);
}

const AmbientBody* WorldAttachment::attach(const Candidate& candidate,
                                           const std::function<std::string()>& whose) {
  if (!candidate.shape || isEmpty(*candidate.shape))
    throw std::invalid_argument("it has no collision shape, so that no fluid acts on it");
  AttachDef def;
  def.medium = medium_;
  def.flow = settings_.flow;
  def.flight = settings_.flight;
  def.fluid_body = source_.fluidBodyOf(whose, *candidate.shape);
  if (btRigidBody* body = btRigidBody::upcast(candidate.object)) {
    if (settings_.adjust) callOf("adjust", [&] { settings_.adjust(*body, def); });
    return def.fluid_body ? &attachBody(bodies_, *body, std::move(def)) : nullptr;
  }
  const auto& collider = *btMultiBodyLinkCollider::upcast(candidate.object);
  btMultiBody& multi_body = *collider.m_multiBody;
  const int link = collider.m_link;
  if (settings_.adjust_link)
    callOf("adjust_link", [&] { settings_.adjust_link(multi_body, link, def); });
  if (!def.fluid_body) return nullptr;
  return &attachLink(bodies_, *multibody_world_, multi_body, link, std::move(def));
}

std::vector<btCollisionObject*> WorldAttachment::seeAll(const btCollisionWorld& world) {
  const std::map<const btCollisionObject*, int> before(seen_.begin(), seen_.end());
  seen_.clear();
  std::vector<btCollisionObject*> strangers;
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    if (const auto* collider = btMultiBodyLinkCollider::upcast(objects[i]))
      if (collider->m_multiBody) giveInstanceNumber(*collider->m_multiBody);
    seen_.emplace_back(objects[i], instanceOf(*objects[i]));
    const auto known = before.find(objects[i]);
    const bool is_known = known != before.end() && known->second == seen_.back().second;
    strangers.push_back(is_known ? nullptr : objects[i]);
  }
  return strangers;
}

template <class Add>
void WorldAttachment::addOr(const btCollisionObject& object, int index, AttachReport& report,
                            const Add& add) const {
  try {
    add();
  } catch (const std::exception& error) {
    report.refused.push_back({index, nameOf(index, object, bodies_) + ": " + error.what()});
  } catch (...) {  // thrown by the program's source
    report.refused.push_back(
        {index, nameOf(index, object, bodies_) + ": something unknown was thrown"});
  }
}

AttachReport WorldAttachment::attachNew(btCollisionWorld& world) {
  AttachReport report;
  Tally tally;
  multibody_world_ = dynamic_cast<btMultiBodyDynamicsWorld*>(&world);
  if (multibody_world_) tally.gravity = multibody_world_->getGravity();
  const std::vector<btCollisionObject*> strangers = seeAll(world);
  const auto count = std::count_if(strangers.begin(), strangers.end(), canJoin);
  std::vector<Candidate> candidates;
  FluidBodySource::Expected expected;
  int number = 0;
  for (std::size_t i = 0; i < strangers.size(); ++i) {
    btCollisionObject* object = strangers[i];
    if (!object) continue;
    const int index = static_cast<int>(i);
    if (canJoin(object)) ++number;
    addOr(*object, index, report, [&] {
      if (!isToAdd(*object, report)) return;
      candidates.push_back({index, number, object, shapeOf(*object)});
      expected.shapes.push_back(candidates.back().shape.get());
    });
  }
  expected.whose = [&](std::size_t k) {
    const Candidate& candidate = candidates[k];
    return nameOf(candidate.index, *candidate.object, bodies_) + ", " +
           std::to_string(candidate.number) + " of " + std::to_string(count);
  };
  const Expecting expecting(source_, expected);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Candidate& candidate = candidates[k];
    addOr(*candidate.object, candidate.index, report, [&] {
      if (const AmbientBody* ambient = attach(candidate, [&] { return expected.whose(k); }))
        tally.add(candidate.index, *ambient, bodies_.trees, report);
    });
  }
  std::stable_sort(report.refused.begin(), report.refused.end(),
                   [](const auto& a, const auto& b) { return a.body < b.body; });
  multibody_world_ = nullptr;
  report.fluid_bodies = static_cast<int>(tally.shapes.size());
  if (tally.lightest) {
    warnOfLightBody(bodies_.warnings, *tally.lightest, tally.mass, tally.light_count);
  }
  return report;
}

// Removals swap the world's array, and a new body may stand where a destroyed one did.
bool WorldAttachment::hasSeenAll(const btCollisionWorld& world) const noexcept {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  if (static_cast<std::size_t>(objects.size()) != seen_.size()) return false;
  for (int i = 0; i < objects.size(); ++i) {
    const auto& [object, instance] = seen_[static_cast<std::size_t>(i)];
    if (object != objects[i] || instance != instanceOf(*objects[i])) return false;
  }
  return true;
}

void WorldAttachment::update(btCollisionWorld& world) noexcept {
  try {
    if (hasSeenAll(world)) return;
    for (const AttachReport::Refusal& refusal : attachNew(world).refused)
      bodies_.warnings.report("bullet_ambient: " + refusal.reason);
  } catch (...) {
    // Out of memory, which must not unwind through Bullet's step: the next one tries again.
  }
}

AMBIENT_END
