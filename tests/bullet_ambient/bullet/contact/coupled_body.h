#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "tests/reference/dense_rows.h"
#include "tests/support/bodies/random_bodies.h"

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

}  // namespace ambient::test
