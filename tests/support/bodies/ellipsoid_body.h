#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/surface_form.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/geodesic.h"

namespace ambient::test {

/// Gives a body the resistance of the ball with its area, about the centre of volume: for tests of
/// what a resistance does, not of what it is.
inline void giveResistance(FluidBody& body) {
  const double pi = portable::acos(-1.0), radius = std::sqrt(body.area / pi) / 2;
  ViscousForm& viscous = body.viscous;
  viscous.resistance.setZero();
  viscous.resistance.diagonal() << Vector3::Constant(8 * pi * radius * radius * radius),
      Vector3::Constant(6 * pi * radius);
  viscous.resistance = shiftOrigin(viscous.resistance, -body.centre_of_volume);
  viscous.centre_of_reaction = body.centre_of_volume;
  viscous.surface = {2 * radius, Vector3::Constant(pi * radius * radius),
                     Vector3::Constant(radius * radius / 3),
                     2.0 / 3 * radius * radius * Matrix3::Identity()};
  viscous.sharp_share = 0.5;
}

inline double ellipsoidVolume(const Vector3& semi_axes) {
  return 4.0 / 3.0 * portable::acos(-1.0) * semi_axes.prod();
}

/// Moments of inertia of a homogeneous ellipsoid [kg m^2].
inline Vector3 ellipsoidMoments(const Vector3& semi_axes, double mass) {
  const Vector3 q = semi_axes.cwiseAbs2();
  return mass / 5 * Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
}

/// Moments of inertia of a homogeneous box [kg m^2].
inline Vector3 boxMoments(const Vector3& size, double mass) {
  const Vector3 q = size.cwiseAbs2();
  return mass / 12 * Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
}

/// Smooth ellipsoid: exact added mass and volume, no faces.
inline FluidBody facelessEllipsoid(const Vector3& semi_axes) {
  FluidBody shape;
  shape.name = "ellipsoid";
  shape.added_mass = reference::ellipsoidAddedMass(semi_axes).asDiagonal();
  shape.volume = ellipsoidVolume(semi_axes);
  shape.area = 4 * portable::acos(-1.0) * portable::pow(semi_axes.prod(), 2.0 / 3.0);
  return shape;
}

/// Ellipsoid of exact added mass and volume with the faces of a geodesic mesh, 20 * 4^level.
inline FluidBody meshedEllipsoid(const Vector3& semi_axes, int level) {
  FluidBody shape = facelessEllipsoid(semi_axes);
  shape.faces = faceTableOf(geodesicEllipsoid(semi_axes, level));
  shape.area = totalArea(shape.faces);
  makeSurfaceForm(shape);
  giveResistance(shape);
  return shape;
}

/// Ellipsoid of triangles between meridians and latitudes: 2 meridians (bands - 1) faces.
inline FluidBody latticeEllipsoid(const Vector3& semi_axes, int meridians, int bands) {
  const double pi = portable::acos(-1.0);
  Triangulation mesh;
  for (int i = 1; i < bands; ++i)
    for (int j = 0; j < meridians; ++j) {
      const double theta = pi * i / bands, phi = 2 * pi * j / meridians;
      mesh.vertices.push_back(semi_axes.cwiseProduct(
          Vector3(portable::sin(theta) * portable::cos(phi),
                  portable::sin(theta) * portable::sin(phi), portable::cos(theta))));
    }
  const int north = static_cast<int>(mesh.vertices.size()), south = north + 1;
  mesh.vertices.push_back({0, 0, semi_axes.z()});
  mesh.vertices.push_back({0, 0, -semi_axes.z()});
  const int last = (bands - 2) * meridians;
  for (int j = 0; j < meridians; ++j) {
    const int next = (j + 1) % meridians;
    mesh.triangles.push_back({north, j, next});
    mesh.triangles.push_back({south, last + next, last + j});
    for (int row = 0; row < last; row += meridians) {
      mesh.triangles.push_back({row + j, row + meridians + j, row + next});
      mesh.triangles.push_back({row + next, row + meridians + j, row + meridians + next});
    }
  }
  FluidBody shape = facelessEllipsoid(semi_axes);
  shape.faces = faceTableOf(mesh);
  shape.area = totalArea(shape.faces);
  makeSurfaceForm(shape);
  giveResistance(shape);
  return shape;
}

/// Nodes and weights of the Gauss rule of `count` points on [0, 1].
inline std::vector<std::pair<double, double>> gaussRule(int count) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < count; ++i) {
    double x = portable::cos(portable::acos(-1.0) * (i + 0.75) / (count + 0.5));
    double slope = 1;
    for (int newton = 0; newton < 8; ++newton) {
      double value = 1, before = 0;  // Legendre polynomials by their recurrence
      for (int n = 0; n < count; ++n) {
        const double next = ((2 * n + 1) * x * value - n * before) / (n + 1);
        before = value;
        value = next;
      }
      slope = count * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule.emplace_back((1 + x) / 2, 1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Sphere with the points of a Gauss rule in cos(theta), for each hemisphere, times equal angles
/// about z, as faces. Drag along z equals the smooth sphere's to rounding: the pressure's
/// integrand is a polynomial on each half. A velocity 0.3 degrees off z switches the faces next
/// to the equator. Below this angle the lateral force has the wrong sign, as on every faceted
/// sphere.
inline FluidBody gaussSphere(double radius) {
  constexpr int kMeridians = 16;
  constexpr int kLatitudes = 16;
  FluidBody shape = facelessEllipsoid(Vector3::Constant(radius));
  const double turn = 2 * portable::acos(-1.0) / kMeridians;
  for (const double side : {1.0, -1.0}) {
    for (const auto& [node, weight] : gaussRule(kLatitudes)) {
      for (int j = 0; j < kMeridians; ++j) {
        const double sine = std::sqrt(1 - node * node);
        const Vector3 normal(sine * portable::cos(j * turn), sine * portable::sin(j * turn),
                             side * node);
        shape.faces.add(normal.normalized(), radius * normal, weight * turn * radius * radius);
      }
    }
  }
  shape.faces.sharpness.assign(shape.faces.size(), 0);  // round
  makeSurfaceForm(shape);
  return shape;
}

}  // namespace ambient::test
