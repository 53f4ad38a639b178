#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <vector>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/robots/link_reference.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

class btMultiBodyConstraint;

namespace ambient::test {

/// An ambient or ordinary body that touches a dry robot of three links; calls a solver for
/// multibodies without a world. The reference has the robot's bodies, then the body.
class ChainTask {
 public:
  /// Moves the body so that its surface point meets the surface point of a link, or of the base,
  /// which is link -1.
  ChainTask(Arbitrary& arbitrary, bool has_fixed_base, int link);

  const CoupledBody& body() const { return body_; }
  btMultiBody& robot() const { return *robot_; }
  int link() const { return link_; }
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
  /// Reference before a step of dt, with the rows of the robot's joints.
  DenseRobot dense(Real dt) const;
  int denseBody() const { return robot_->getNumLinks() + 2; }    ///< number of the body in dense()
  int denseGround() const { return robot_->getNumLinks() + 1; }  ///< number of what never moves

  /// Returns false if the residual stays above the threshold of the settings.
  bool solve(const btContactSolverInfo& info, btMultiBodyConstraint* joint = nullptr);

 private:
  reference::DenseRow oriented(reference::DenseRow row) const;

  CoupledBody body_;
  std::unique_ptr<btMultiBody> robot_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;  // of the base first
  int link_;
  Vector3r point_;
  bool body_is_a_ = true;
  std::unique_ptr<btPersistentManifold> manifold_;
};

/// Tolerance of links. Bullet's recursion in float32 loses digits: 3e-5 for one of 600 chains, 8e-6
/// with ordinary bodies instead of ambient ones.
constexpr double kLinkTolerance = sizeof(btScalar) == 8 ? kTolerance : 5e-5;

/// Velocities before a step, and the larger error of body and robot after it.
struct BeforeChain {
  explicit BeforeChain(const ChainTask& task)
      : body(task.body().velocity()), robot(twistsOf(task.robot())) {}
  double error(const ChainTask& task, const reference::DenseSolution& expected) const;
  DenseVector6 body;
  std::vector<DenseVector6> robot;
};

/// Makes an ambient body that touches a random movable link of a robot with a free or fixed base.
ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base);

/// Applies random forces and torques. Returns the step for which they and the gyroscopic terms
/// change the body's velocity by 5 %.
double pushedTime(Arbitrary& arbitrary, const ChainTask& task);

/// convergingSettings() with 300 iterations at most: rows that need more are nearly dependent, and
/// rounding decides the split between impulses.
btContactSolverInfo chainSettings(double dt);

}  // namespace ambient::test
