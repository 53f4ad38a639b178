#include "demos/pybullet/world_fluid.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <cstdio>
#include <stdexcept>
#include <utility>

#include "demos/pybullet/server_world.h"

namespace ambient::pybullet {
namespace {

constexpr std::size_t kKeptSentences = 100;
const char* const kOtherLayout =
    "this PyBullet has other layouts than the plugin, which is for 3.1.7 and later in double";

btMultiBodyDynamicsWorld& requireLayout(btMultiBodyDynamicsWorld& world) {
  if (!hasOurLayout(world)) throw std::invalid_argument(kOtherLayout);
  return world;
}

// Returns the name of an object in reports, such as "PyBullet's body 3, link 2 elbow": PyBullet's
// numbers and the name in the URDF file.
std::string nameOf(const btCollisionObject& object) {
  const auto* collider = btMultiBodyLinkCollider::upcast(&object);
  if (!collider) return "PyBullet's body " + std::to_string(object.getUserIndex2());
  const btMultiBody& multi_body = *collider->m_multiBody;
  const int link = collider->m_link;
  const char* given = link < 0 ? multi_body.getBaseName() : multi_body.getLink(link).m_linkName;
  std::string name = "PyBullet's body " + std::to_string(multi_body.getUserIndex2());
  if (link >= 0) name += ", link " + std::to_string(link);
  return given ? name + " " + given : name;
}

}  // namespace

WorldFluid::WorldFluid(btMultiBodyDynamicsWorld& world, std::set<std::string>& printed)
    : world_(requireLayout(world)), printed_(printed), fluid_(world, SolverOwner::kAsksWorld) {
  fluid_.setNaming(nameOf);
  fluid_.setReport([this](const std::string& sentence) { say(sentence); });
}

void WorldFluid::say(const std::string& sentence) {
  if (printed_.insert(sentence).second) std::fprintf(stderr, "%s\n", sentence.c_str());
  if (said_.size() < kKeptSentences) said_.push_back(sentence);
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
  storeHandles();
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
    say("bullet_ambient: " + refusal.reason);
}

// Stores the handles of new members under their numbers. PyBullet reuses only numbers of removed
// bodies, whose handles forget() has erased.
void WorldFluid::storeHandles() {
  for (const auto& [key, body] : new_bodies_)
    if (const auto member = fluid_.find(*body)) members_.insert_or_assign(key, *member);
  for (const auto& [key, multi_body] : new_links_)
    if (const auto member = fluid_.find(*multi_body, key.second))
      members_.insert_or_assign(key, *member);
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
  states_.push_back(fluid_.save());
  return states_.size() - 1;
}

void WorldFluid::restore(std::size_t state) {
  if (state >= states_.size())
    throw std::invalid_argument("this world has " + std::to_string(states_.size()) +
                                " saved states, and no state " + std::to_string(state));
  fluid_.restore(states_[state]);
}

}  // namespace ambient::pybullet
