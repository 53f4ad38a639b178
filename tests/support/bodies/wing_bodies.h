#pragma once

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/geodesic.h"

namespace ambient::test {

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
    body.surface.triangles.insert(body.surface.triangles.end(), triangle.begin(), triangle.end());
  makeSurfaceForm(body);
  return body;
}

}  // namespace ambient::test
