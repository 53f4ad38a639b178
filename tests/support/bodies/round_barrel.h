#pragma once

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/hull_bodies.h"

namespace ambient::test {

/// Barrel about an axis through the origin, in rings of 16: quarter turns map its triangles onto
/// themselves. Its added mass has mirrors, across the axis where the ends are alike.
inline FluidBody roundBarrel(int axis, bool has_equal_ends) {
  constexpr int kRows = 8, kAround = 16;
  Triangulation mesh;
  const auto add = [&](double x, double y, double z) {
    Vector3 place;
    place[(axis + 1) % 3] = x;
    place[(axis + 2) % 3] = y;
    place[axis] = z;
    mesh.vertices.push_back(place);
  };
  for (int row = 0; row <= kRows; ++row)
    for (int j = 0; j < kAround; ++j) {
      const double z = 2.0 * row / kRows - 1, angle = 2 * kPi * j / kAround;
      const double radius = 0.7 - 0.3 * z * z + (has_equal_ends ? 0 : 0.1 * z);
      add(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  add(0, 0, -1);
  add(0, 0, 1);
  const auto at = [](int row, int j) { return row * kAround + j % kAround; };
  const int low = (kRows + 1) * kAround, high = low + 1;
  for (int j = 0; j < kAround; ++j) {
    mesh.triangles.emplace_back(low, at(0, j + 1), at(0, j));
    mesh.triangles.emplace_back(high, at(kRows, j), at(kRows, j + 1));
    for (int row = 0; row < kRows; ++row) {
      const int a = at(row, j), b = at(row, j + 1), c = at(row + 1, j + 1), d = at(row + 1, j);
      const bool falls = (row + j) % 2 == 0;
      mesh.triangles.emplace_back(a, b, falls ? d : c);
      mesh.triangles.emplace_back(falls ? b : a, c, d);
    }
  }
  FluidBody body = hullBody(mesh);
  AddedMassPart part;
  part.centre = {0.3, 0.3, 0.3};
  part.inertia.setIdentity();
  std::vector<AddedMassPart> images;
  for (int turned = 0; turned < 8; ++turned)
    if (has_equal_ends || !(turned >> axis & 1)) images.push_back(imageOf(part, turned));
  body.added_mass_parts = images;
  return body;
}

}  // namespace ambient::test
