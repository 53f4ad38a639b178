#include "bullet_ambient/bullet/ambient_trees.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

AmbientLink::AmbientLink(int number)
    : link(number),
      stand_in(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, nullptr, {1, 1, 1})) {
  ambient.body = &stand_in;
}

TreeStep::TreeStep(Eigen::Index n) : start(n), moved(n), end(n), share(n), change(n), spare(n) {}

AmbientTree::AmbientTree(btMultiBody& attached)
    : multi_body(&attached),
      tree(makeLinkTree(attached)),
      flight(tree),
      step(coordinateCount(tree)) {
  readPose(attached, step.pose);
}

AmbientLink* AmbientTree::find(int link) const noexcept {
  const auto found = std::find_if(links.begin(), links.end(),
                                  [link](const auto& other) { return other->link == link; });
  return found == links.end() ? nullptr : found->get();
}

AmbientTree* AmbientTrees::find(const btMultiBody* multi_body) const noexcept {
  if (trees_.empty()) return nullptr;
  const auto found = by_body_.find(multi_body);
  return found == by_body_.end() ? nullptr : found->second;
}

AmbientLink& AmbientTrees::require(const btMultiBody& multi_body, int link) const {
  const AmbientTree* tree = find(&multi_body);
  AmbientLink* found = tree ? tree->find(link) : nullptr;
  if (!found) {
    throw std::invalid_argument("link " + std::to_string(link) +
                                " of this btMultiBody is not attached to the ambient registry");
  }
  return *found;
}

void AmbientTrees::insert(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
                          std::unique_ptr<AmbientLink> link) {
  AmbientTree* tree = find(&multi_body);
  if (!tree) {
    trees_.push_back(std::make_unique<AmbientTree>(multi_body));
    tree = trees_.back().get();
    by_body_.emplace(&multi_body, tree);
  }
  tree->links.push_back(std::move(link));
  world_ = &world;
}

bool AmbientTrees::erase(const btMultiBody& multi_body, int link) {
  AmbientTree* tree = find(&multi_body);
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
  AmbientTree* tree = find(&multi_body);
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

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
