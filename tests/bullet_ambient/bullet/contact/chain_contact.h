#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <vector>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/contact/joints/link_chain.h"

class btMultiBodyConstraint;

namespace ambient::test {

/// An ambient or ordinary body that touches a chain of links; calls a solver for multibodies
/// without a world. The reference has the body as number 0, then the chain.
class ChainTask {
 public:
  /// Moves the body so that its surface point meets the surface point of the chain's `link_body`.
  ChainTask(Arbitrary& arbitrary, CoupledBody body, LinkChain chain, int link_body);

  const CoupledBody& body() const { return body_; }
  const LinkChain& chain() const { return chain_; }
  int linkBody() const { return link_body_; }
  Vector3r point() const { return point_; }  ///< contact point, world

  /// Adds a contact with the body as A, or as B; random normal along which the bodies approach.
  void touch(Arbitrary& arbitrary, bool body_is_a) {
    touchAlong(toBt(arbitrary.vector()).normalized(), body_is_a);
  }
  void touchAlong(const btVector3& normal_or_opposite, bool body_is_a);
  btManifoldPoint& contact() { return manifold_->getContactPoint(0); }
  Real approach() const;

  /// Row along a direction at the contact, with the signs of Bullet's rows.
  reference::DenseRow row(const Vector3r& direction) const;
  reference::DenseRow spinRow(const Vector3r& direction) const;
  /// Reference bodies before a step of dt.
  std::vector<reference::DenseBody> dense(Real dt) const;

  /// Returns false if the residual stays above the threshold of the settings.
  bool solve(const btContactSolverInfo& info, btMultiBodyConstraint* joint = nullptr);

 private:
  reference::DenseRow oriented(reference::DenseRow row) const;

  CoupledBody body_;
  LinkChain chain_;
  int link_body_;
  Vector3r point_;
  bool body_is_a_ = true;
  std::unique_ptr<btPersistentManifold> manifold_;
};

/// Velocities before a step, and the larger error of body and chain after it.
struct BeforeChain {
  explicit BeforeChain(const ChainTask& task)
      : body(task.body().velocity()), chain(task.chain().velocities()) {}
  double error(const ChainTask& task, const reference::DenseSolution& expected) const;
  DenseVector6 body;
  std::array<DenseVector6, LinkChain::kBodies> chain;
};

/// Makes an ambient body and a chain with a free or fixed base. The body touches `link_body`, or a
/// random movable one.
ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base, int link_body);
ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base);

/// Applies random forces and torques. Returns the step for which they and the gyroscopic terms
/// change the body's velocity by 5 %.
double pushedTime(Arbitrary& arbitrary, const ChainTask& task);

/// convergingSettings() with 300 iterations at most: rows that need more are nearly dependent, and
/// rounding decides the split between impulses.
btContactSolverInfo chainSettings(double dt);

}  // namespace ambient::test
