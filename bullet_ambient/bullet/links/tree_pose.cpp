#include "bullet_ambient/bullet/links/tree_pose.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/bullet/core/attitude.h"

AMBIENT_BEGIN
namespace {

// Sets a turn that Bullet has computed up to kTurnRounding. Returns true if a number has changed.
bool settleTurn(btQuaternion& now, const Quaternion& turned) {
  const btQuaternion exact = toBullet(turned.normalized());
  if (now == exact || !((toQuaternion(now).conjugate() * turned).vec().norm() <= kTurnRounding))
    return false;
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
        limit_(static_cast<double>(body_.getMaxCoordinateVelocity())),
        h_(h) {}

  // Each function returns true if it has changed a number.

  bool settleBase() {
    const Vector3 turn = wayAlong(0);
    if (links_.front().keeps_position || turn.isZero(0)) return false;
    btQuaternion to_base = body_.getWorldToBaseRot();
    if (!settleTurn(to_base, turnedByBullet(step_.pose.orientation, turn).conjugate()))
      return false;
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
        has_changed |= settleSpherical(from, wayAlong(first), bullet);
      if (link.joint.kind == JointKind::kPlanar && !link.keeps_position)
        settlePlanar(from, wayAlong(first), bullet);
      has_changed |= settleLink(bullet);
      first += axisCount(link.joint.kind);
    }
    return has_changed;
  }

 private:
  // Returns the way in the step along three coordinates from `first` on.
  Vector3 wayAlong(int first) const {
    return h_ * step_.moved.segment<3>(first).cwiseMin(limit_).cwiseMax(-limit_);
  }

  static bool settleSpherical(const JointPosition& from, const Vector3& turn,
                              btMultibodyLink& link) {
    if (turn.isZero(0)) return false;
    btScalar* p = link.m_jointPos;
    btQuaternion now(p[0], p[1], p[2], p[3]);
    const Quaternion start(from[3], from[0], from[1], from[2]);
    if (!settleTurn(now, start * turnOfBullet(turn))) return false;
    for (int i = 0; i < 4; ++i) p[i] = now[i];
    link.updateCacheMultiDof();
    return true;
  }

  // Bullet has turned the way by the angle at the end of the step.
  static void settlePlanar(const JointPosition& from, const Vector3& way, btMultibodyLink& link) {
    constexpr btScalar kRounding = 16 * std::numeric_limits<btScalar>::epsilon();
    const btVector3 way_B = static_cast<btScalar>(way[1]) * link.getAxisBottom(1) +
                            static_cast<btScalar>(way[2]) * link.getAxisBottom(2);
    const btVector3 turned = quatRotate(turnAbout(link.getAxisTop(0), link.m_jointPos[0]), way_B);
    for (int i : {1, 2}) {
      const auto start = static_cast<btScalar>(from[static_cast<std::size_t>(i)]);
      const btScalar gone = link.getAxisBottom(i).dot(turned), exact = start + gone;
      const btScalar size = std::abs(start) + std::abs(gone);
      if (std::abs(link.m_jointPos[i] - exact) <= kRounding * size) link.m_jointPos[i] = exact;
    }
  }

  const TreeStep& step_;
  const std::vector<Link>& links_;
  btMultiBody& body_;
  const double limit_;  // of each coordinate of the velocity
  const double h_;
};

}  // namespace

void settleTree(AmbientTree& tree, double h) noexcept {
  MovedTree moved(tree, h);
  const bool has_turned = moved.settleBase();
  if (moved.settleJoints() || has_turned)
    tree.multi_body->updateCollisionObjectWorldTransforms(tree.to_local, tree.origins);
}

AMBIENT_END
