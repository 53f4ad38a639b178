#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "tests/reference/dense_rows.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/solver_kinds.h"

namespace ambient::test {

using reference::DenseMatrix6;
using reference::DenseVector6;
using reference::Real;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;

/// Tolerance of rewritten rows for bodies with K_fluid up to 1e4 times K_body.
constexpr double kTolerance = sizeof(btScalar) == 8 ? 1e-12 : 1e-5;

inline Vector3r exact(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Matrix3r exact(const btMatrix3x3& m);
inline btVector3 toBt(const Vector3& v) {
  return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

/// A btRigidBody without shape in an ideal fluid, with a random K_fluid and no faces: inertia is
/// the fluid's only effect.
class CoupledBody {
 public:
  /// Mass 0.1 to 10 kg, size 0.1 to 1 m, random pose and velocity. `fluid_ratio`: largest ratio of
  /// K_fluid to K_body in the length scale of the body; 0: no fluid.
  static CoupledBody random(Arbitrary& arbitrary, double fluid_ratio);
  /// Makes an immovable body.
  static CoupledBody fixed();

  /// Puts the body into its fluid; does nothing for one without.
  void attachTo(AmbientBodies& members) const;

  btRigidBody& body() const { return *body_; }
  double size() const { return size_; }
  bool isFixed() const { return fixed_; }
  bool isAmbient() const { return fluid_.norm() > 0; }
  DenseVector6 velocity() const;  ///< present velocity, world axes
  void setVelocity(const DenseVector6& velocity) const;
  DenseMatrix6 inertia() const;  ///< K in world axes
  /// Body for the dense solver: K and the velocity of docs/theory.md eq. (28) after dt.
  reference::DenseBody dense(Real dt) const;
  /// Largest duration for which gyroscopic terms change the velocity by less than `part`, in the
  /// norm of K.
  double gyroscopicTime(double part) const;
  /// |velocity() - expected| over the larger of |expected|, |before|; angular parts times size.
  double error(const DenseVector6& expected, const DenseVector6& before) const;

 private:
  std::unique_ptr<btRigidBody> body_;
  Matrix6 fluid_ = Matrix6::Zero();
  double size_ = 1;
  bool fixed_ = false;
};

/// Two bodies with a contact point; calls a solver without a world.
class ContactPair {
 public:
  /// Moves b so that its surface point meets a's; both points lie within twice the size of their
  /// body. The normal points from b to a.
  ContactPair(Arbitrary& arbitrary, CoupledBody a, CoupledBody b);

  /// Adds a contact at another place with another normal.
  void addPoint(Arbitrary& arbitrary);
  int points() const { return manifold_.getNumContacts(); }

  /// Reverses both velocities if the points move apart.
  void makeApproaching();
  void setVelocities(const DenseVector6& u_a, const DenseVector6& u_b);
  /// Returns velocity of a's point minus velocity of b's point along a direction.
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
  /// Rows of the first point at the start of a step of dt: the normal row, which ends with
  /// `normal_velocity`, and two friction rows with the point's coefficient.
  std::vector<reference::DenseRow> frictionRows(Real normal_velocity, FrictionBound bound, Real dt);
  /// Bodies for the dense solver, at the start of a step of dt.
  std::vector<reference::DenseBody> dense(Real dt) const { return {a_.dense(dt), b_.dense(dt)}; }

  /// Attaches the ambient bodies and solves once with a new solver. Returns false
  /// if a complementarity solver fell back to sequential impulses, or if an
  /// iterative solver missed the residual of the settings. A joint replaces the
  /// contacts.
  template <class Kind>
  bool solve(const btContactSolverInfo& info, btTypedConstraint* joint = nullptr) {
    const auto members = std::make_shared<AmbientBodies>();
    a_.attachTo(*members);
    b_.attachTo(*members);
    typename Kind::Ambient ambient(members);
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

/// Settings without position correction, thresholds and other defaults of Bullet. Tests enable the
/// terms they need.
btContactSolverInfo plainSettings(double dt);

// Contacts of an ambient body of coupled inertia, K_fluid from 1e-3 to 1e4 times K_body, with a
// fixed, an ordinary or an ambient body.

/// Returns the velocity that a contact asks for, docs/theory.md eq. (28e). `bounce`: restitution
/// times the speed of the approach; `push`: change of the velocity along the row by the forces on
/// bodies in a fluid; `correction`: by a penetration, < 0: by a gap.
inline Real contactTarget(Real bounce, Real push, Real correction) {
  if (!(bounce > 0)) return correction;
  const Real speed = std::max<Real>(0, bounce + std::min<Real>(0, push));
  return correction < 0 ? speed + correction : std::max(speed, correction);
}

enum class Other { kPlane, kOrdinary, kAmbient };
constexpr Other kOthers[] = {Other::kPlane, Other::kOrdinary, Other::kAmbient};

double arbitraryRatio(Arbitrary& arbitrary);

/// Two bodies that approach each other.
ContactPair arbitraryPair(Arbitrary& arbitrary, Other other);

/// Largest duration for which gyroscopic terms of both bodies change their velocities by `part`.
double gyroscopicTime(const ContactPair& pair, double part);

/// Applies forces and torques that change the velocities by about 5 % during dt. No torques on
/// bodies without fluid: Bullet's stock friction rows ignore them.
void pushAtRandom(Arbitrary& arbitrary, const ContactPair& pair, double dt);

/// Velocities of a pair before a step.
struct Before {
  explicit Before(const ContactPair& pair) : a(pair.a().velocity()), b(pair.b().velocity()) {}
  DenseVector6 a, b;
};

/// Larger of both bodies' CoupledBody::error.
double worstError(const ContactPair& pair, const reference::DenseSolution& expected,
                  const Before& before);

using Rows = std::vector<reference::DenseRow>;

/// plainSettings() with iterations until changes are below rounding.
btContactSolverInfo convergingSettings(double dt);

/// Least independence() compared. Below it rows are nearly dependent: iterations converge slowly,
/// and rounding decides the split between impulses.
constexpr Real kIndependent = 0.05L;

/// Error of one of many random cases; none: it cannot be compared.
using CaseError = std::optional<double>;

/// Expects errors below a tolerance, errorOf(arbitrary, i) for i = 0 ... count - 1, and more than
/// `least` of them.
template <class Case>
void expectErrors(unsigned seed, int count, int least, double tolerance, const Case& errorOf) {
  Arbitrary arbitrary(seed);
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < count; ++i) {
    const CaseError error = errorOf(arbitrary, i);
    if (!error) continue;
    ++compared;
    worst = std::max(worst, *error);
  }
  EXPECT_GT(compared, least);
  EXPECT_LT(worst, tolerance);
}

/// Tells if a row pushes. Bodies without any impulse fly freely, which the dense solution does not
/// contain.
bool touch(const reference::DenseSolution& solution);

}  // namespace ambient::test
