#include "bullet_ambient/bullet/links/tree_pose.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bullet_ambient/bullet/core/attitude.h"
#include "bullet_ambient/bullet/core/conversions.h"

AMBIENT_BEGIN
namespace {

// Sets a turn that Bullet has computed up to kTurnRounding. Returns true if a number has changed.
bool settleTurn(btQuaternion& now, btQuaternion exact) {
  exact.normalize();
  if (now == exact) return false;
  const auto half_angle = static_cast<double>((now - exact).length());
  if (!(2 * half_angle <= kTurnRounding)) return false;
  now = exact;
  return true;
}

// A tree that Bullet has moved.
class MovedTree {
 public:
  MovedTree(AmbientTree& tree, double h)
      : step_(tree.step),
        links_(tree.tree.links),
        body_(*tree.multi_body),
        h_(static_cast<btScalar>(h)) {}

  // Each function returns true if it has changed a number.

  bool settleBase() {
    const btVector3 spin = velocityAlong(0);
    if (links_.front().keeps_position || spin.isZero()) return false;
    btQuaternion to_base = body_.getWorldToBaseRot();
    if (!settleTurn(to_base, step_.to_base * turnInStep(spin, h_).inverse())) return false;
    body_.setWorldToBaseRot(to_base);
    return true;
  }

  bool settleJoints() {
    bool has_changed = false;
    int first = 6;
    for (int i = 0; i < body_.getNumLinks(); ++i) {
      const Link& link = links_[static_cast<std::size_t>(i) + 1];
      btMultibodyLink& bullet = body_.getLink(i);
      const JointPosition& from = step_.pose.joints[static_cast<std::size_t>(i) + 1];
      if (link.joint.kind == JointKind::kSpherical && !link.keeps_position)
        has_changed |= settleSpherical(from, velocityAlong(first), bullet);
      if (link.joint.kind == JointKind::kPlanar && !link.keeps_position)
        settlePlanar(from, velocityAlong(first), bullet);
      has_changed |= settleLink(bullet);
      first += axisCount(link.joint.kind);
    }
    return has_changed;
  }

 private:
  // Returns three coordinates, from `first` on, of the velocity that Bullet has moved the tree by.
  btVector3 velocityAlong(int first) const {
    return toBullet(Vector3(step_.moved.segment<3>(first)));
  }

  bool settleSpherical(const JointPosition& from, const btVector3& spin,
                       btMultibodyLink& link) const {
    if (spin.isZero()) return false;
    btScalar* p = link.m_jointPos;
    btQuaternion now(p[0], p[1], p[2], p[3]);
    const btQuaternion start = toBullet(Quaternion(from[3], from[0], from[1], from[2]));
    if (!settleTurn(now, turnInStep(quatRotate(start, spin), h_) * start)) return false;
    for (int i = 0; i < 4; ++i) p[i] = now[i];
    link.updateCacheMultiDof();
    return true;
  }

  // Bullet has turned the way by the angle at the end of the step.
  void settlePlanar(const JointPosition& from, const btVector3& velocity,
                    btMultibodyLink& link) const {
    constexpr btScalar kRounding = 16 * std::numeric_limits<btScalar>::epsilon();
    const btVector3 turned =
        quatRotate(turnAbout(link.getAxisTop(0), link.m_jointPos[0]),
                   velocity[1] * link.getAxisBottom(1) + velocity[2] * link.getAxisBottom(2));
    for (int i : {1, 2}) {
      const auto start = static_cast<btScalar>(from[static_cast<std::size_t>(i)]);
      const btScalar way = link.getAxisBottom(i).dot(turned) * h_, exact = start + way;
      const btScalar rounding = kRounding * (std::abs(start) + std::abs(way));
      if (std::abs(link.m_jointPos[i] - exact) <= rounding) link.m_jointPos[i] = exact;
    }
  }

  const TreeStep& step_;
  const std::vector<Link>& links_;
  btMultiBody& body_;
  const btScalar h_;
};

}  // namespace

void settleTree(AmbientTree& tree, double h) noexcept {
  MovedTree moved(tree, h);
  const bool has_turned = moved.settleBase();
  if (moved.settleJoints() || has_turned)
    tree.multi_body->updateCollisionObjectWorldTransforms(tree.to_local, tree.origins);
}

AMBIENT_END
