#pragma once

#include <Eigen/Geometry>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/geodesic.h"

namespace ambient::test {

/// A valid fluid body with a different value in each field; no real shape has these values.
inline FluidBody exampleBody(int level = 1) {
  const Triangulation mesh = geodesicEllipsoid({1, 0.5, 0.25}, level);
  FluidBody body;
  body.name = "example";
  body.provenance = {"example.obj",
                     0xfedcba9876543210u,
                     "faces 80, scale 1",
                     "tests 0",
                     {"it has holds", "it was wrapped"}};
  for (int row = 0; row < 6; ++row)
    for (int col = 0; col < 6; ++col)
      body.added_mass(row, col) = row == col ? 1 + row : 0.01 * (row + col);
  body.added_mass(1, 4) += 1e-12;  // rounding, must survive in its entry
  body.asymmetry = 1.25e-9;
  body.volume = 0.5;
  body.area = 2.75;
  body.centre_of_volume = {0.1, -0.2, 0.3};
  body.origin = {-4, 5, -6};
  body.uniform_mass = {{0.11, 0.12, 0.13}, Vector3(0.2, 0.3, 0.4).asDiagonal()};
  body.surface_mass = {{0.21, 0.22, 0.23}, Vector3(0.5, 0.6, 0.7).asDiagonal()};
  body.uniform_mass.inertia(0, 1) = body.uniform_mass.inertia(1, 0) = 0.015625;
  body.faces = faceTableOf(mesh);
  for (const Vector3& v : mesh.vertices)
    body.surface.vertices.insert(body.surface.vertices.end(), {v.x(), v.y(), v.z()});
  for (const Eigen::Vector3i& t : mesh.triangles)
    body.surface.triangles.own().insert(body.surface.triangles.end(), {t[0], t[1], t[2]});
  makeSurfaceForm(body);
  return body;
}

/// The example with a different value in each number of its viscous form, as far as these can
/// differ.
inline FluidBody viscousBody() {
  FluidBody body = exampleBody();
  double value = 0;
  for (double* number : body.viscous.numbers()) *number = value += 1.0 / 128;
  body.viscous.resistance = body.added_mass;
  body.viscous.separation.axes = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).matrix();
  body.viscous.surface.gyration = body.surface_mass.inertia;
  body.viscous.is_primitive = true;
  return body;
}

}  // namespace ambient::test
