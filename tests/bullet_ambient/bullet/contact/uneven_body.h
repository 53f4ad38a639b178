#pragma once

#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

/// Body of 1 kg with unequal principal moments.
inline BodyDef unevenBody() { return {1, {0.4, 0.5, 0.6}}; }

/// Fluid body of an added mass alone: no volume, no faces.
inline FluidBody inertiaAlone(const Matrix6& added_mass) {
  FluidBody shape = shapeWithoutFaces(added_mass);
  shape.volume = 0;
  return shape;
}

/// Coupled added mass with the largest eigenvalue `largest` per unit of density.
inline FluidBody unevenFluid(Arbitrary& arbitrary, double largest) {
  const Matrix6 shape = arbitrary.positiveDefinite();
  return inertiaAlone(largest / symmetricEigen<6>(shape).values[5] * shape);
}

/// Kinetic energy of body and fluid [J].
inline double kineticEnergy(const FluidWorld& scene, const btRigidBody& body) {
  const Vector6 x = readState(body).twist.vector();
  return x.dot(scene.of(body).inertia() * x) / 2;
}

/// Momentum of body and fluid; angular about the origin of the world.
inline Momentum worldMomentum(const FluidWorld& scene, const btRigidBody& body) {
  const RigidState state = readState(body);
  const auto m = Momentum::fromVector(scene.of(body).inertia() * state.twist.vector());
  const Vector3 linear = state.orientation * m.linear;
  return {state.orientation * m.angular + state.position.cross(linear), linear};
}

}  // namespace ambient::test
