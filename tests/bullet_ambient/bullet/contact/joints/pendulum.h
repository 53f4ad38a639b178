#pragma once

#include <cmath>

#include "bullet_ambient/immersed/ambient_body.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/elliptic.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

constexpr double kLength = 1;  // pivot to centre of mass [m]
constexpr double kMass = 2;    // [kg]
inline const Vector3 kMoments{0.3, 0.4, 0.2};

/// Suspension: point or hinge of the world, or point of a btMultiBody at rest.
enum class Suspension { kPoint, kHinge, kLink };

/// K of a body symmetric about the plane of the swing: no moment drives the body out of the plane,
/// where a point joint would let it go.
inline Matrix6 symmetricAboutPlane(Matrix6 K) {
  Vector6 mirror;
  mirror << -1, -1, 1, 1, 1, -1;
  return (K + mirror.asDiagonal() * K * mirror.asDiagonal()) / 2;
}

/// Pendulum below the origin of the world.
struct Pendulum {
  Suspension suspension = Suspension::kHinge;
  Matrix6 added_mass = Matrix6::Zero();  // fluid of density 1
  Quaternion hanging = Quaternion::Identity();
  double amplitude = 0;

  static Pendulum random(Suspension suspension, unsigned seed, double amplitude) {
    Arbitrary arbitrary(seed);
    Pendulum p;
    p.suspension = suspension;
    p.amplitude = amplitude;
    p.added_mass = 0.5 * arbitrary.positiveDefinite();
    if (suspension != Suspension::kHinge) {
      p.added_mass = symmetricAboutPlane(p.added_mass);
    } else {
      p.hanging = Quaternion(arbitrary.rotation());
    }
    return p;
  }

  RigidState start() const {
    const Quaternion turn(Eigen::AngleAxisd(amplitude, Eigen::Vector3d::UnitZ()));
    RigidState state;
    state.orientation = turn * hanging;
    state.position = turn * Vector3(0, -kLength, 0);
    return state;
  }
  Vector3 pivot() const { return hanging.conjugate() * Vector3(0, kLength, 0); }  ///< body axes
  Vector3 axis() const { return hanging.conjugate() * Vector3::UnitZ(); }
  double angle(const btRigidBody& body) const {
    const Vector3 x = readState(body).orientation * hanging.conjugate() * Vector3::UnitX();
    return std::atan2(x.y(), x.x());
  }
  double inertia() const {
    Matrix6 K = added_mass;
    K.topLeftCorner<3, 3>() += kMoments.asDiagonal();
    K.bottomRightCorner<3, 3>() += kMass * Matrix3::Identity();
    const Vector6 s = stack(axis(), axis().cross(-pivot()));
    return s.dot(K * s);
  }
  double period() const {
    const double frequency = std::sqrt(kMass * kGravity * kLength / inertia());
    return 4 / frequency * reference::completeEllipticK(std::sin(amplitude / 2));
  }
};

}  // namespace ambient::test
