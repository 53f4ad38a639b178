#pragma once

#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/free_body.h"
#include "tests/support/random_bodies.h"

namespace ambient::test {

/// 1 kg whose principal moments differ.
inline BodyDef unevenBody() {
  BodyDef def;
  def.moments = {0.4, 0.5, 0.6};
  return def;
}

/// An added mass alone: no volume and no faces.
inline FluidBody inertiaAlone(const Matrix6& added_mass) {
  FluidBody shape = shapeWithoutFaces(added_mass);
  shape.volume = 0;
  return shape;
}

/// It couples everything; its largest eigenvalue is `largest` per unit of density.
inline FluidBody unevenFluid(Arbitrary& arbitrary, double largest) {
  const Matrix6 shape = arbitrary.positiveDefinite();
  return inertiaAlone(largest / symmetricEigen<6>(shape).values[5] * shape);
}

/// Of body and fluid [J].
inline double kineticEnergy(const FluidWorld& scene, const btRigidBody& body) {
  const Vector6 x = readState(body).twist.vector();
  return x.dot(scene.registry.inertia(body) * x) / 2;
}

/// Of body and fluid, angular about the origin of the world.
inline Momentum worldMomentum(const FluidWorld& scene, const btRigidBody& body) {
  const RigidState state = readState(body);
  const auto m = Momentum::fromVector(scene.registry.inertia(body) * state.twist.vector());
  const Vector3 linear = state.orientation * m.linear;
  return {state.orientation * m.angular + state.position.cross(linear), linear};
}

}  // namespace ambient::test
