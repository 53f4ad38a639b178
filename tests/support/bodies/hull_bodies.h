#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

/// C_N of a thin plate of an aspect ratio >= 1 at an incidence [rad], docs/theory.md eq. (43) to
/// (43c) in closed form.
inline double normalForceOfPlate(double aspect, double incidence) {
  const double s = std::sin(incidence), c_sq = 1 - s * s;
  const double sigma = 0.18 + (std::sqrt(0.5) - 0.18) * std::pow(aspect, -1.5);
  const double x = s * s / (2 * sigma * sigma);
  const double attached = x < 1 ? std::pow(1 - x * x, 2) : 0;
  const double slope = 2 * kPi * aspect / (2 + std::sqrt(4 + aspect * aspect));
  const double separated = (1 - attached) * (1.05 * s * s + 2.34 * s * (1 - s)) + 0.12 * s * s;
  return separated + attached * s * (slope * c_sq + kPi * s);
}

/// A body with the triangles of a mesh as surface and faces, and the mesh's volume.
inline FluidBody hullBody(const Triangulation& mesh) {
  FluidBody body;
  body.name = "hull";
  for (const Vector3& v : mesh.vertices)
    body.surface.vertices.insert(body.surface.vertices.end(), {v.x(), v.y(), v.z()});
  for (const Eigen::Vector3i& t : mesh.triangles) {
    body.surface.triangles.own().insert(body.surface.triangles.end(), {t[0], t[1], t[2]});
    const auto corner = [&](int i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    body.volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  body.faces = faceTableOf(mesh);
  body.area = totalArea(body.faces);
  makeSurfaceForm(body);
  giveResistance(body);
  return body;
}

/// A closed bumpy body beside the origin.
inline FluidBody bumpyBody(Arbitrary& arbitrary) {
  Triangulation mesh = geodesicSphere(2);
  for (Vector3& v : mesh.vertices) v = arbitrary.between(0.7, 1.3) * v + Vector3(0.1, 0.2, -0.3);
  return hullBody(mesh);
}

/// A box about the origin; each side has `divisions` squared rectangles of two triangles. The sides
/// share no vertices.
inline Triangulation boxMesh(const Vector3& size, int divisions) {
  Triangulation mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {1, -1}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3, n = divisions + 1;
      const int base = static_cast<int>(mesh.vertices.size());
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          Vector3 p;
          p[axis] = side * size[axis] / 2;
          p[u] = size[u] * (static_cast<double>(i) / divisions - 0.5);
          p[v] = size[v] * (static_cast<double>(j) / divisions - 0.5);
          mesh.vertices.push_back(p);
        }
      for (int i = 0; i < divisions; ++i)
        for (int j = 0; j < divisions; ++j) {
          const int a = base + i * n + j, b = a + n, c = b + 1, d = a + 1;
          if (side > 0) {
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
          } else {
            mesh.triangles.emplace_back(a, c, b);
            mesh.triangles.emplace_back(a, d, c);
          }
        }
    }
  return mesh;
}

inline FluidBody boxBody(const Vector3& size, int divisions = 1) {
  return hullBody(boxMesh(size, divisions));
}

/// Fluid body of these faces, with the added mass of a plate that faces z.
inline FluidBody bodyOfFaces(FaceTable faces) {
  FluidBody body;
  body.name = "body";
  body.faces = std::move(faces);
  for (const double area : body.faces.area) body.area += area;
  body.added_mass(5, 5) = 1;
  makeSurfaceForm(body);
  return body;
}

/// Thin plate across z, of chord 1 m along x and span `aspect` along y, both sides in the fluid,
/// with the added mass of a strip.
inline FluidBody rectangularWing(double aspect, int per_chord = 24) {
  FaceTable faces;
  const int per_span = static_cast<int>(std::lround(per_chord * aspect));
  const double dx = 1.0 / per_chord, dy = aspect / per_span;
  for (const double side : {1.0, -1.0})
    for (int i = 0; i < per_chord; ++i)
      for (int j = 0; j < per_span; ++j)
        faces.add({0, 0, side}, {(i + 0.5) * dx - 0.5, (j + 0.5) * dy - aspect / 2, 0}, dx * dy);
  faces.sharpness.assign(faces.size(), 1);
  FluidBody body = bodyOfFaces(std::move(faces));
  body.added_mass(5, 5) = kPi / 4 * aspect;
  makeSurfaceForm(body);
  return body;
}

/// Ellipsoid with these semi-axes, x the longest [m]; its added mass along x is 0.08 V, across 0.86
/// V, those of a spheroid of 4 : 1.
inline FluidBody smoothHull(const Vector3& semi_axes, int level = 3) {
  Triangulation mesh = geodesicSphere(level);
  for (Vector3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(semi_axes);
  FluidBody body = bodyOfFaces(faceTableOf(mesh));
  body.volume = 4 * kPi / 3 * semi_axes.prod();
  body.added_mass.setZero();
  body.added_mass.bottomRightCorner<3, 3>() = Vector3(0.08, 0.86, 0.86).asDiagonal();
  body.added_mass *= body.volume;
  for (const Vector3& vertex : mesh.vertices)
    body.surface.vertices.insert(body.surface.vertices.end(), vertex.data(), vertex.data() + 3);
  for (const auto& triangle : mesh.triangles)
    body.surface.triangles.own().insert(body.surface.triangles.end(), triangle.begin(),
                                        triangle.end());
  makeSurfaceForm(body);
  return body;
}

}  // namespace ambient::test
