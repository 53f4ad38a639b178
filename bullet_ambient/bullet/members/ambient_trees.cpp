#include "bullet_ambient/bullet/members/ambient_trees.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/members/tree_state.h"

AMBIENT_BEGIN

TreeStep::TreeStep(Eigen::Index n, std::size_t links)
    : start(n),
      moved(n),
      end(Coordinates::Zero(n)),
      share(n),
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
  if (trees_.empty()) return nullptr;
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

void AmbientTrees::insert(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
                          std::unique_ptr<AmbientLink> link) {
  AmbientTree* tree = find(&multi_body);
  if (!tree) {
    trees_.push_back(std::make_unique<AmbientTree>(multi_body));
    tree = trees_.back().get();
    by_body_.emplace(&multi_body, tree);
  }
  AMBIENT_ASSERT(link && link->link < multi_body.getNumLinks() && !tree->find(link->link));
  slots_.enter({&link->ambient, tree});
  tree->links.push_back(std::move(link));
  world_ = &world;
}

void AmbientTrees::replace(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
                           std::vector<std::unique_ptr<AmbientLink>> links) {
  auto tree = std::make_unique<AmbientTree>(multi_body);
  for (std::unique_ptr<AmbientLink>& link : links) {
    const Member member{&link->ambient, tree.get()};
    if (AmbientLink* before = find(&multi_body, link->link)) {
      keepName(before->ambient.def->name, link->ambient);
      link->ambient.reading = before->ambient.reading;
      slots_.replace(before->ambient, member);
    } else {
      slots_.enter(member);
    }
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
  slots_.leave(found->ambient);
  tree->tree.links[link + 1].model = nullptr;
  tree->tree.links[link + 1].surroundings = {};
  tree->links.erase(std::find_if(tree->links.begin(), tree->links.end(),
                                 [found](const auto& other) { return other.get() == found; }));
  return true;
}

bool AmbientTrees::erase(const btMultiBody& multi_body) {
  AmbientTree* tree = at(&multi_body);
  if (!tree) return false;
  for (const auto& link : tree->links) slots_.leave(link->ambient);
  by_body_.erase(&multi_body);
  trees_.erase(std::find_if(trees_.begin(), trees_.end(),
                            [tree](const auto& other) { return other.get() == tree; }));
  if (trees_.empty()) world_ = nullptr;
  return true;
}

void AmbientTrees::clear() {
  for (const auto& tree : trees_)
    for (const auto& link : tree->links) slots_.leave(link->ambient);
  trees_.clear();
  by_body_.clear();
  world_ = nullptr;
}

AMBIENT_END
