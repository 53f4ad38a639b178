#include "bullet_ambient/bullet/members/ambient_bodies.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/fluid_regions.h"

AMBIENT_BEGIN

TreeStep::TreeStep(Eigen::Index n, std::size_t links)
    : start(n),
      moved(n),
      end(Coordinates::Zero(n)),
      turning(n),
      change(n),
      spare(n),
      impulses(links) {
  surface.start.resize(n);
  surface.pose.joints.resize(links);
  surface.middle.joints.resize(links);
}

AmbientTree::AmbientTree(btMultiBody& attached)
    : multi_body(&attached),
      instance(giveInstanceNumber(attached)),
      tree(makeLinkTree(attached)),
      flight(tree),
      step(coordinateCount(tree), tree.links.size()) {
  readPose(attached, step.pose);
  to_local.resize(tree.size());
  origins.resize(tree.size());
}

AmbientLink* AmbientTree::find(int link) const noexcept {
  const auto found = std::find_if(links.begin(), links.end(),
                                  [link](const auto& other) { return other->link == link; });
  return found == links.end() ? nullptr : found->get();
}

bool AmbientTree::isSame() const noexcept {
  if (!multi_body->isUsingRK4Integration()) return instanceNumber(*multi_body) == instance;
  return hasLinksOf(*multi_body, tree);
}

AmbientTree* AmbientTrees::at(const btMultiBody* address) const noexcept {
  if (!address || trees_.empty()) return nullptr;
  const auto found = by_body_.find(address);
  return found == by_body_.end() ? nullptr : found->second;
}

AmbientTree* AmbientTrees::find(const btMultiBody* multi_body) const noexcept {
  AmbientTree* tree = at(multi_body);
  return tree && tree->isSame() ? tree : nullptr;
}

AmbientLink* AmbientTrees::find(const btMultiBody* multi_body, int link) const noexcept {
  const AmbientTree* tree = find(multi_body);
  return tree ? tree->find(link) : nullptr;
}

AmbientLink& AmbientTrees::linkOf(const AmbientBody& link) const noexcept {
  const auto& links = treeOf(link).links;
  const auto found = std::find_if(links.begin(), links.end(),
                                  [&link](const auto& other) { return &other->ambient == &link; });
  AMBIENT_ASSERT(found != links.end());
  return **found;
}

void AmbientTrees::insert(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
                          std::unique_ptr<AmbientLink> link) {
  AmbientTree* tree = find(&multi_body);
  if (!tree) {
    trees_.push_back(std::make_unique<AmbientTree>(multi_body));
    tree = trees_.back().get();
    by_body_.emplace(&multi_body, tree);
  }
  AMBIENT_ASSERT(link && link->link < multi_body.getNumLinks() && !tree->find(link->link));
  link->ambient.multi_body = &multi_body;
  setHandle(link->ambient, nullptr);
  tree->links.push_back(std::move(link));
  world_ = &world;
}

void AmbientTrees::replace(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
                           std::vector<std::unique_ptr<AmbientLink>> links) {
  auto tree = std::make_unique<AmbientTree>(multi_body);
  for (std::unique_ptr<AmbientLink>& link : links) {
    const AmbientLink* before = find(&multi_body, link->link);
    link->ambient.multi_body = &multi_body;
    setHandle(link->ambient, before ? &before->ambient : nullptr);
    tree->links.push_back(std::move(link));
  }
  erase(multi_body);
  if (tree->links.empty()) return;
  by_body_.emplace(&multi_body, tree.get());
  trees_.push_back(std::move(tree));
  world_ = &world;
}

bool AmbientTrees::erase(const btMultiBody& multi_body, int link) {
  AmbientTree* tree = at(&multi_body);
  AmbientLink* found = tree ? tree->find(link) : nullptr;
  if (!found) return false;
  if (tree->links.size() == 1) return erase(multi_body);
  tree->tree.links[link + 1].model = nullptr;
  tree->tree.links[link + 1].surroundings = {};
  tree->links.erase(std::find_if(tree->links.begin(), tree->links.end(),
                                 [found](const auto& other) { return other.get() == found; }));
  return true;
}

bool AmbientTrees::erase(const btMultiBody& multi_body) {
  AmbientTree* tree = at(&multi_body);
  if (!tree) return false;
  by_body_.erase(&multi_body);
  trees_.erase(std::find_if(trees_.begin(), trees_.end(),
                            [tree](const auto& other) { return other.get() == tree; }));
  if (trees_.empty()) world_ = nullptr;
  return true;
}

void AmbientTrees::clear() {
  trees_.clear();
  by_body_.clear();
  world_ = nullptr;
}

void BodyIndex::reserveOne() {
  if (3 * (count_ + 1) > 2 * entries_.size()) grow();
}

void BodyIndex::insert(const btCollisionObject* object, Iterator iterator) {
  reserveOne();
  Entry& entry = entries_[slotOf(object)];
  AMBIENT_ASSERT(!entry.object);
  entry = {object, iterator};
  ++count_;
}

void BodyIndex::erase(const btCollisionObject* object) noexcept {
  std::size_t gap = slotOf(object);
  AMBIENT_ASSERT(entries_[gap].object == object);
  // Moves later entries into the gap, so that no search ends there too early.
  const std::size_t mask = entries_.size() - 1;
  for (std::size_t at = next(gap); entries_[at].object; at = next(at)) {
    const std::size_t distance = (at - homeOf(entries_[at].object)) & mask;
    if (distance < ((at - gap) & mask)) continue;
    entries_[gap] = entries_[at];
    gap = at;
  }
  entries_[gap] = {};
  --count_;
}

void BodyIndex::clear() noexcept {
  entries_.clear();
  count_ = 0;
}

void BodyIndex::grow() {
  std::vector<Entry> known(entries_.empty() ? 8 : 2 * entries_.size());
  known.swap(entries_);
  for (const Entry& entry : known)
    if (entry.object) entries_[slotOf(entry.object)] = entry;
}

namespace {

int readNumber(const btRigidBody& body) noexcept;

// Bullet has no accessor for the number. The arguments of an explicit instantiation are not subject
// to access control ([temp.spec.general]), which lends one without a change of Bullet.
template <int btRigidBody::*kNumber>
struct NumberReader {
  friend int readNumber(const btRigidBody& body) noexcept { return body.*kNumber; }
};
template struct NumberReader<&btRigidBody::m_debugBodyId>;

}  // namespace

int instanceNumber(const btRigidBody& body) noexcept { return readNumber(body); }

AmbientBody* AmbientBodies::find(const btCollisionObject* body) const {
  const auto found = by_object_.find(body);
  if (!found) return nullptr;
  AmbientBody& ambient = **found;
  return isSame(ambient) ? &ambient : nullptr;
}

bool AmbientBodies::isSame(const AmbientBody& ambient) {
  const btCollisionObject* object = ambient.body;
  const btRigidBody* rigid = btRigidBody::upcast(object);
  return rigid && instanceNumber(*rigid) == ambient.instance;
}

AmbientBody& AmbientBodies::insert(AmbientBody ambient) {
  std::list<AmbientBody> last;
  AmbientBody& added = last.emplace_back(std::move(ambient));
  added.instance = instanceNumber(*added.body);
  by_object_.reserveOne();
  setHandle(added, find(added.body));
  has_vessels = has_vessels || added.vessel;
  erase(*added.body);  // or what is left of one that was destroyed at this address
  by_object_.insert(added.body, last.begin());
  bodies_.splice(bodies_.end(), last);
  return added;
}

bool AmbientBodies::erase(const btRigidBody& body) {
  const auto found = by_object_.find(&body);
  if (!found) return false;
  forgetSolved(**found);
  by_object_.erase(&body);
  bodies_.erase(*found);
  return true;
}

void AmbientBodies::clear() {
  solved_list_ = nullptr;
  by_object_.clear();
  bodies_.clear();
  trees.clear();
}

void AmbientBodies::close() {
  clear();
  regions = {};
  warnings.setReport(nullptr);
  task_runner = nullptr;
  naming = nullptr;
  is_closed = true;
}

void AmbientBodies::requireChangeable(const char* function) {
  RegionCall* call = RegionCall::current(regions);
  if (!call) return;
  call->was_refused = true;
  const std::string sentence =
      std::string("bullet_ambient: the flow or the surface of a region of fluid has called ") +
      function +
      ", which changes what is asked for its fluid; nothing has changed: call it between "
      "steps";
  warnings.warnOnce(Warning::kChange, sentence.c_str());
  throw std::logic_error(sentence);
}

void AmbientBodies::noteSolved(AmbientBody& ambient) noexcept {
  if (std::exchange(ambient.outcome.kind, Outcome::kStock) != Outcome::kNotSolved) return;
  ambient.next_solved = solved_list_.load(std::memory_order_relaxed);
  while (!solved_list_.compare_exchange_weak(ambient.next_solved, &ambient)) {
  }
}

// Between steps the list is empty, unless there is no action to take it.
void AmbientBodies::forgetSolved(const AmbientBody& ambient) noexcept {
  AmbientBody* other = solved_list_.load();
  if (other == &ambient) solved_list_ = ambient.next_solved;
  for (; other; other = other->next_solved) {
    if (other->next_solved == &ambient) other->next_solved = ambient.next_solved;
  }
}

AMBIENT_END
