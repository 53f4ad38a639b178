#include "bullet_ambient/bullet/members/link_carrier.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cstddef>

AMBIENT_BEGIN
namespace {

bool isFixed(const btMultiBody& body, int link) {
  return link >= 0 && body.getLink(link).m_jointType == btMultibodyLink::eFixed;
}

// Pose of a link at a fixed joint in its parent's frame; does not depend on the tree's motion.
btTransform poseInParent(const btMultibodyLink& link) {
  const btQuaternion turn = link.m_cachedRotParentToThis.inverse();
  return btTransform(turn, quatRotate(turn, link.m_cachedRVector));
}

}  // namespace

std::optional<FixedLink> carrierOf(const btMultiBody& body, int link) {
  const auto mass = [&](int of) { return of < 0 ? body.getBaseMass() : body.getLinkMass(of); };
  std::vector<FixedLink> reached{{link, btTransform::getIdentity()}};
  const auto reach = [&](int next, const btTransform& pose) {
    const auto is_next = [next](const FixedLink& known) { return known.link == next; };
    if (std::none_of(reached.begin(), reached.end(), is_next)) reached.push_back({next, pose});
  };
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const FixedLink here = reached[i];
    if (mass(here.link) > 0 || (here.link < 0 && body.hasFixedBase())) return here;
    if (isFixed(body, here.link)) {
      const btMultibodyLink& joint = body.getLink(here.link);
      reach(joint.m_parent, poseInParent(joint) * here.pose);
    }
    for (int child = here.link + 1; child < body.getNumLinks(); ++child)
      if (isFixed(body, child) && body.getParent(child) == here.link)
        reach(child, poseInParent(body.getLink(child)).inverse() * here.pose);
  }
  return std::nullopt;
}

std::vector<FixedLink> carriedBy(const btMultiBody& body, int carrier) {
  std::vector<FixedLink> carried;
  for (int link = -1; link < body.getNumLinks(); ++link) {
    if (link == carrier) continue;
    const auto found = carrierOf(body, link);
    if (found && found->link == carrier) carried.push_back({link, found->pose});
  }
  return carried;
}

AMBIENT_END
