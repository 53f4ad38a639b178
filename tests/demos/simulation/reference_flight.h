#pragma once

#include <string>

#include "demos/scene/scene.h"
#include "tests/reference/ellipsoid_flight.h"

namespace ambient {

/// A body of a scene as the reference has it. @pre a sphere or an ellipsoid in a still medium
inline reference::EllipsoidInFluid ellipsoidOf(const Scene& scene, std::size_t index) {
  const BodyDef& body = scene.bodies[index];
  reference::EllipsoidInFluid ellipsoid;
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape.geometry))
    ellipsoid.semi_axes = Vector3::Constant(sphere->radius);
  else
    ellipsoid.semi_axes = std::get<EllipsoidShape>(body.shape.geometry).semi_axes;
  ellipsoid.mass = body.mass;
  // A ball: solid, or a shell.
  const double share = body.mass_kind == MassKind::kSurface ? 2.0 / 3 : 0.4;
  ellipsoid.moments = share * body.mass * ellipsoid.semi_axes.cwiseAbs2();
  if (body.inertia) ellipsoid.moments = body.inertia->diagonal();
  ellipsoid.density = scene.medium.density;
  ellipsoid.viscosity = body.flow.skin_friction ? scene.medium.viscosity : 0;
  ellipsoid.separation_angle = body.flow.separation_angle;
  ellipsoid.gravity = scene.gravity;
  return ellipsoid;
}

/// Its flight, from the origin.
inline reference::EllipsoidFlight referenceFlight(const Scene& scene, std::size_t index = 0) {
  const BodyDef& body = scene.bodies[index];
  return {ellipsoidOf(scene, index), body.orientation, body.linear_velocity, body.angular_velocity};
}

}  // namespace ambient
