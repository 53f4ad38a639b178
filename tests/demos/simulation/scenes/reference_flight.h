#pragma once

#include <string>

#include "demos/scene/scene.h"
#include "tests/reference/ellipsoid_flight.h"

namespace ambient {

/// Converts a body of a scene for the reference. @pre a sphere or an ellipsoid in a still medium
inline reference::EllipsoidInFluid ellipsoidOf(const Scene& scene, std::size_t index) {
  const BodyDef& body = scene.bodies[index];
  reference::EllipsoidInFluid ellipsoid;
  if (const auto* sphere = std::get_if<Sphere>(&body.shape.geometry))
    ellipsoid.semi_axes = Vector3::Constant(sphere->radius);
  else
    ellipsoid.semi_axes = std::get<Ellipsoid>(body.shape.geometry).semi_axes;
  ellipsoid.mass = body.mass;
  // Moment of inertia of a ball: solid or shell.
  const double share = body.mass_kind == MassKind::kSurface ? 2.0 / 3 : 0.4;
  ellipsoid.moments = share * body.mass * ellipsoid.semi_axes.cwiseAbs2();
  if (body.inertia) ellipsoid.moments = body.inertia->diagonal();
  ellipsoid.density = scene.medium.density;
  ellipsoid.viscosity = body.attach.flow.skin_friction ? scene.medium.viscosity : 0;
  ellipsoid.separation_angle = body.attach.flow.separation_angle;
  ellipsoid.gravity = scene.gravity;
  return ellipsoid;
}

/// Reference flight of a body of a scene, from the origin.
inline reference::EllipsoidFlight referenceFlight(const Scene& scene, std::size_t index = 0) {
  const BodyDef& body = scene.bodies[index];
  return {ellipsoidOf(scene, index), body.orientation, body.linear_velocity, body.angular_velocity};
}

}  // namespace ambient
