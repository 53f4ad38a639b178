#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>

#include "bullet_ambient/bullet/ambient_registry.h"
#include "tests/reference/dense_rows.h"
#include "tests/support/random_bodies.h"

namespace ambient::test {

using reference::DenseMatrix6;
using reference::DenseVector6;
using reference::Real;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;

/// Accuracy that the rewritten rows must have for bodies whose K_fluid is up to 1e4 times K_body.
constexpr double kTolerance = sizeof(btScalar) == 8 ? 1e-12 : 1e-5;

inline Vector3r exact(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Matrix3r exact(const btMatrix3x3& m);
inline btVector3 toBt(const Vector3& v) {
  return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

/// A btRigidBody without a shape, in a fluid that has an arbitrary K_fluid and no faces: nothing
/// but inertia acts.
class CoupledBody {
 public:
  /// Mass 0.1 to 10 kg, size 0.1 to 1 m, any pose and velocity. `fluid_ratio`: largest ratio of
  /// K_fluid to K_body in the length scale of the body; 0: a body without fluid.
  static CoupledBody random(Arbitrary& arbitrary, double fluid_ratio);
  /// Immovable.
  static CoupledBody fixed();

  /// Puts the body into its fluid; does nothing for one without.
  void attachTo(AmbientRegistry& registry) const;

  btRigidBody& body() const { return *body_; }
  double size() const { return size_; }
  bool isFixed() const { return fixed_; }
  bool isAmbient() const { return fluid_.norm() > 0; }
  DenseVector6 velocity() const;  ///< now, world axes
  void setVelocity(const DenseVector6& velocity) const;
  DenseMatrix6 inertia() const;  ///< K in world axes
  /// What the dense solver needs: K and the velocity of docs/theory.md eq. (28) after dt.
  reference::DenseBody dense(Real dt) const;
  Real kineticEnergy(const DenseVector6& velocity) const;
  /// Linear momentum and angular momentum about the world's origin.
  DenseVector6 momentum(const DenseVector6& velocity) const;
  /// Largest duration over which the gyroscopic terms change the velocity by less than `part` of
  /// itself, in the norm of K.
  double gyroscopicTime(double part) const;
  /// |now - expected| over the larger of |expected| and |before|, angular parts times the size.
  double error(const DenseVector6& expected, const DenseVector6& before) const;

 private:
  std::unique_ptr<btRigidBody> body_;
  Matrix6 fluid_ = Matrix6::Zero();
  double size_ = 1;
  bool fixed_ = false;
};

}  // namespace ambient::test
