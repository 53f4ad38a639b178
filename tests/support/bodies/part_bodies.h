#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/hull_bodies.h"

namespace ambient::test {

/// Outer potentials of an ellipsoid's six unit motions about its centre, on its surface. Linear for
/// translation, bilinear for rotation; amplitudes from the added mass.
inline Vector6 ellipsoidPotentials(const FluidBody& body, const Vector3& semi_axes,
                                   const Vector3& z) {
  const Vector6 K = body.added_mass.diagonal();
  const Vector3 q = semi_axes.cwiseAbs2();
  Vector6 phi;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double difference = q[j] - q[k];
    phi[i] = difference == 0 ? 0 : -5 * K[i] / (body.volume * difference) * z[j] * z[k];
    phi[3 + i] = -K[3 + i] / body.volume * z[i];
  }
  return phi;
}

/// Parts of up to 16 faces of a meshed ellipsoid, as the preprocessor makes them.
inline std::vector<AddedMassPart> ellipsoidParts(const FluidBody& body, const Vector3& semi_axes) {
  constexpr std::size_t kFaces = 16;
  const FaceTable& faces = body.faces;
  std::vector<Vector6> coordinates;
  for (std::size_t i = 0; i < faces.size(); ++i)
    coordinates.push_back(stack(faces.normal(i), faces.centroid(i)));
  const std::vector<std::uint32_t> order = orderInBlocks(coordinates, kFaces);
  std::vector<AddedMassPart> parts;
  for (std::size_t begin = 0; begin < order.size(); begin += kFaces) {
    const std::size_t end = std::min(begin + kFaces, order.size());
    AddedMassPart part;
    double area = 0;
    for (std::size_t k = begin; k < end; ++k) area += faces.area[order[k]];
    for (std::size_t k = begin; k < end; ++k)
      part.centre += faces.area[order[k]] / area * faces.centroid(order[k]);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = order[k];
      const Vector3 c = faces.centroid(i), n = faces.normal(i), r = c - part.centre;
      Vector6 products;
      products << r.x() * r.x(), r.y() * r.y(), r.z() * r.z(), r.x() * r.y(), r.x() * r.z(),
          r.y() * r.z();
      part.spread += faces.area[i] / area * products;
      const Vector6 g = stack(c.cross(n), n), phi = ellipsoidPotentials(body, semi_axes, c);
      part.inertia -= faces.area[i] / 2 * (g * phi.transpose() + phi * g.transpose());
    }
    parts.push_back(part);
  }
  return parts;
}

/// An ellipsoid with exact added mass, a hull of 20 * 4^level triangles and parts.
inline FluidBody floatingEllipsoid(const Vector3& semi_axes, int level) {
  const FluidBody smooth = facelessEllipsoid(semi_axes);
  FluidBody body = hullBody(geodesicEllipsoid(semi_axes, level));
  body.added_mass = smooth.added_mass;
  body.volume = smooth.volume;
  body.added_mass_parts = ellipsoidParts(body, semi_axes);
  giveResistance(body);
  return body;
}

/// A sphere with its hull.
inline FluidBody floatingBall(double radius, int level = 2) {
  FluidBody body = hullBody(geodesicEllipsoid(Vector3::Constant(radius), level));
  const FluidBody smooth = facelessEllipsoid(Vector3::Constant(radius));
  body.added_mass = smooth.added_mass;
  body.volume = smooth.volume;
  body.sphere_radius = radius;
  return body;
}

/// A box of uniform density without parts. Added mass: an ellipsoid of equal volume.
inline FluidBody floatingBox(const Vector3& size, int divisions = 2) {
  FluidBody body = boxBody(size, divisions);
  body.added_mass =
      facelessEllipsoid(size * portable::cbrt(3 / (4 * portable::acos(-1.0)))).added_mass;
  return body;
}

/// The same with the moments of its uniform mass, by which it has stations along its length.
inline std::shared_ptr<FluidBody> longBox(const Vector3& size, int divisions = 2) {
  auto body = std::make_shared<FluidBody>(floatingBox(size, divisions));
  body->uniform_mass.inertia = boxMoments(size, 1).asDiagonal();
  return body;
}

}  // namespace ambient::test
