#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "tests/bullet_ambient/bullet/contact/coupled_body.h"
#include "tests/support/solver_kinds.h"

namespace ambient::test {

/// Two bodies that touch in one point, handed to a solver without a world.
class ContactPair {
 public:
  /// The second body is moved to where the first one's surface point is its own, both points
  /// within twice the size of their body; the normal points from b to a.
  ContactPair(Arbitrary& arbitrary, CoupledBody a, CoupledBody b);

  /// A further contact at another place with another normal.
  void addPoint(Arbitrary& arbitrary);
  int points() const { return manifold_.getNumContacts(); }

  /// Turns both velocities around if the points move apart, so that the bodies meet.
  void makeApproaching();
  void setVelocities(const DenseVector6& u_a, const DenseVector6& u_b);
  /// Velocity of a's point minus that of b's along a direction.
  Real approach(const Vector3r& direction, const DenseVector6& u_a, const DenseVector6& u_b,
                int at = 0) const;

  btManifoldPoint& point(int at = 0) { return manifold_.getContactPoint(at); }
  const CoupledBody& a() const { return a_; }
  const CoupledBody& b() const { return b_; }
  Vector3r normal(int at = 0) const;
  Vector3r tangent(int i, int at = 0) const;
  Vector3r fromA(int at = 0) const;  ///< from a's centre of mass to the contact
  Vector3r fromB(int at = 0) const;
  reference::DenseRow row(const Vector3r& direction, int at = 0) const;
  /// Normal row of the first point that ends with `normal_velocity`, and two friction rows with the
  /// coefficient of the point, as a step of dt begins.
  std::vector<reference::DenseRow> frictionRows(Real normal_velocity, FrictionBound bound, Real dt);
  /// Bodies for the dense solver, before the step.
  std::vector<reference::DenseBody> dense(Real dt) const { return {a_.dense(dt), b_.dense(dt)}; }

  /// Attaches what is ambient and solves once with a new solver. False if a complementarity solver
  /// gave up and handed over to sequential impulses, or, where the settings ask for a residual, if
  /// iterations have not reached it.
  /// With a joint, the bodies do not touch.
  template <class Kind>
  bool solve(const btContactSolverInfo& info, btTypedConstraint* joint = nullptr) {
    AmbientRegistry registry;
    a_.attachTo(registry);
    b_.attachTo(registry);
    typename Kind::Ambient ambient(registry);
    SolverTask task;
    task.bodies.push_back(&a_.body());
    if (!b_.isFixed()) task.bodies.push_back(&b_.body());
    if (joint) {
      task.joints.push_back(joint);
    } else {
      task.manifolds.push_back(&manifold_);
    }
    task.info = info;
    solveOnce(ambient.solver, task);
    return hasFinished(ambient.solver, info);
  }

 private:
  void addPointAt(const btVector3& at, const btVector3& normal);

  CoupledBody a_, b_;
  btPersistentManifold manifold_;
};

/// Settings without any of Bullet's position terms, thresholds and defaults that a test did not
/// ask for.
btContactSolverInfo plainSettings(double dt);

}  // namespace ambient::test
