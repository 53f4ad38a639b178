#pragma once

#include <cmath>

#include "demos/integrators/integrators.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"

namespace ambient::test {

/// A disc that glides at an incidence and turns slowly. No face changes between windward and lee,
/// so that loads are smooth functions of the motion.
inline FreeBody glidingDisc(const FlightSettings& settings) {
  FluidBody shape;
  shape.name = "disc";
  shape.added_mass.diagonal() << 1e-4, 1e-4, 0, 0, 0, 2e-2;
  shape.added_mass(0, 5) = shape.added_mass(5, 0) = 2e-4;
  shape.area = 0.06;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::acos(-1.0) / 3;
    for (const double side : {1.0, -1.0}) {
      shape.faces.add({0, 0, side}, {0.1 * std::cos(angle), 0.07 * std::sin(angle), 0}, 5e-3);
    }
  }
  FreeBody disc({shape,
                 {0.05, Vector3(2e-4, 2e-4, 4e-4).asDiagonal()},
                 {1.2, 1.8e-5, Vector3::Zero(), Vector3::Zero()}});
  disc.settings = settings;
  disc.setGravity({0, 0, -9.81});
  disc.state.twist = {{0.3, 0.5, 4}, {6, 1, -5}};
  return disc;
}

/// A faceted ellipsoid that tumbles: faces often change between windward and lee.
inline FreeBody tumblingEllipsoid(const FlightSettings& settings) {
  const Vector3 semi_axes(0.05, 0.05, 0.01);
  const FluidBody shape = meshedEllipsoid(semi_axes, 2);
  const double mass = 2e-4;
  FreeBody plate({shape, {mass, ellipsoidMoments(semi_axes, mass).asDiagonal()}, air()});
  plate.settings = settings;
  plate.setGravity({0, 0, -9.81});
  plate.state.twist = {{2, 1, 3}, {0.2, 0.3, -0.5}};
  return plate;
}

constexpr double kDuration = 0.4;  // duration of the flights [s]

using MakeBody = FreeBody (*)(const FlightSettings&);

/// End of such a flight, to rounding for a large number of `steps`.
inline RigidState exactEnd(MakeBody make, int steps) {
  FreeBody body = make({1e-3, 1, flyRungeKutta});
  body.advance(kDuration / steps, steps);
  return body.state;
}

}  // namespace ambient::test
