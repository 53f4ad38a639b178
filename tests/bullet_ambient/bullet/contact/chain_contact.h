#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <vector>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/contact/link_chain.h"

class btMultiBodyConstraint;

namespace ambient::test {

/// An ambient body, or an ordinary one, that meets a chain of links, handed to a solver for
/// multibodies without a world. Body 0 of the reference, the chain follows.
class ChainTask {
 public:
  /// The body is moved to where its own surface point is that of the chain's `link_body`.
  ChainTask(Arbitrary& arbitrary, CoupledBody body, LinkChain chain, int link_body);

  const CoupledBody& body() const { return body_; }
  const LinkChain& chain() const { return chain_; }
  int linkBody() const { return link_body_; }
  Vector3r point() const { return point_; }  ///< where they meet, world

  /// Contact with the body as A, or as B. The normal is drawn so that they approach.
  void touch(Arbitrary& arbitrary, bool body_is_a) {
    touchAlong(toBt(arbitrary.vector()).normalized(), body_is_a);
  }
  void touchAlong(const btVector3& normal_or_opposite, bool body_is_a);
  btManifoldPoint& contact() { return manifold_->getContactPoint(0); }
  Real approach() const;

  /// Row along a direction at the contact, in the orientation of Bullet's rows.
  reference::DenseRow row(const Vector3r& direction) const;
  reference::DenseRow spinRow(const Vector3r& direction) const;
  /// Reference bodies before a step of dt.
  std::vector<reference::DenseBody> dense(Real dt) const;

  /// False if the iterations have not reached the residual of the settings.
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

/// An ambient body and a chain with a free or fixed base that meets it with its body `link_body`,
/// or with an arbitrary one that can move.
ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base, int link_body);
ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base);

/// Step over which the gyroscopic terms of the body change its velocity by 5 %, forces and torques
/// likewise.
double pushedTime(Arbitrary& arbitrary, const ChainTask& task);

/// convergingSettings() that give up after 300 iterations: rows that need more say nearly the same,
/// and rounding decides between their impulses.
btContactSolverInfo chainSettings(double dt);

}  // namespace ambient::test
