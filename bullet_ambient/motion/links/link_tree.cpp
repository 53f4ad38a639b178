#include "bullet_ambient/motion/links/link_tree.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
namespace {

[[noreturn]] void rejectLink(int link, const char* quantity, double value, const char* limit) {
  throw std::invalid_argument("link " + std::to_string(link) + ": " + quantity + " is " +
                              std::to_string(value) + ", must be " + limit);
}

}  // namespace

int coordinateCount(const LinkTree& tree) {
  int count = 6;
  for (int l = 1; l < tree.size(); ++l) count += axisCount(tree.links[l].joint.kind);
  return count;
}

void checkTree(const LinkTree& tree) {
  if (tree.size() < 1) throw std::invalid_argument("a tree of links needs a base");
  for (int l = 0; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    if (l == 0 ? link.parent != -1 : !(link.parent >= 0 && link.parent < l)) {
      rejectLink(l, "its parent", link.parent, "a link before it, -1 for the base alone");
    }
    if (!(link.mass >= 0) || !std::isfinite(link.mass)) {
      rejectLink(l, "mass [kg]", link.mass, "zero or positive and finite");
    }
    for (const double moment : link.inertia) {
      if (!(moment >= 0) || !std::isfinite(moment)) {
        rejectLink(l, "moment of inertia [kg m^2]", moment, "zero or positive and finite");
      }
    }
  }
}

void movePose(const LinkTree& tree, const TreePose& from, const CoordinatesIn& u, double h,
              TreePose& to) noexcept {
  AMBIENT_ASSERT(from.joints.size() == to.joints.size());
  AMBIENT_ASSERT(static_cast<int>(to.joints.size()) == tree.size());
  if (tree.links[0].keeps_position) {
    to.orientation = from.orientation;
    to.position = from.position;
  } else {
    const Vector3 turn = h * u.head<3>(), way = h * u.segment<3>(3);
    to.orientation = (rotationFromVector(turn) * from.orientation).normalized();
    to.position = from.position + way;
  }
  int first = 6;
  for (int l = 1; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    to.joints[l] = link.keeps_position ? from.joints[l]
                                       : moved(link.joint, from.joints[l], u.data() + first, h);
    first += axisCount(link.joint.kind);
  }
}

void velocityBetween(const LinkTree& tree, const TreePose& from, const TreePose& to, double h,
                     CoordinatesOut u) noexcept {
  if (!tree.links[0].keeps_position) {
    u.head<3>() = rotationVector(to.orientation * from.orientation.conjugate()) / h;
    u.segment<3>(3) = (to.position - from.position) / h;
  }
  int first = 6;
  for (int l = 1; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    if (!link.keeps_position)
      velocityBetween(link.joint, from.joints[l], to.joints[l], h, u.data() + first);
    first += axisCount(link.joint.kind);
  }
}

bool turnsTooFastForBullet(const LinkTree& tree, const CoordinatesIn& u, double h) noexcept {
  AMBIENT_ASSERT(h > 0);
  const double limit = 0.25 * kPi / h;
  bool is_too_fast = u.head<3>().norm() > limit;
  int first = 6;
  for (int l = 1; l < tree.size(); ++l) {
    const JointKind kind = tree.links[l].joint.kind;
    if (kind == JointKind::kSpherical)
      is_too_fast = is_too_fast || u.segment<3>(first).norm() > limit;
    first += axisCount(kind);
  }
  return is_too_fast;
}

RestInFlow restInFlow(const LinkTree& tree) noexcept {
  const Vector3* flow = nullptr;
  bool is_one = true;
  for (const Link& link : tree.links) {
    if (!link.model) continue;
    if (!flow) flow = &link.surroundings.ambient_velocity;
    is_one = is_one && link.surroundings.ambient_velocity == *flow;
  }
  if (!flow) return {Vector3::Zero(), true};
  if (tree.links[0].keeps_velocity) return {Vector3::Zero(), is_one && flow->isZero(0)};
  return {*flow, is_one};
}

bool restInFlow(const LinkTree& tree, CoordinatesOut u) noexcept {
  const RestInFlow rest = restInFlow(tree);
  u.setZero();
  u.segment<3>(3) = rest.velocity;
  return rest.exists;
}

bool findFlow(const LinkTree& tree, const CoordinatesIn& u, Coordinates& flow) noexcept {
  if (!restInFlow(tree, flow)) return false;
  int first = 0;
  for (int l = 0; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    const int count = l == 0 ? 6 : axisCount(link.joint.kind);
    if (link.keeps_velocity && count > 0 && u.segment(first, count).cwiseAbs().maxCoeff() > 0)
      return false;
    first += count;
  }
  return true;
}

}  // namespace ambient
