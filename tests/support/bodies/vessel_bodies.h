#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {

/// An open barge; F has its origin in the middle of the closed box. The numbers of
/// docs/theory.md section 20 hold for its default.
struct OpenBarge {
  Vector3 size{2, 1, 0.5};
  double wall = 0.02;
  double hole = 0;      ///< area of a square hole in its floor [m^2]; 0: none
  int holds = 1;        ///< side by side along x, with bulkheads of one wall to the rim
  double door = 0;      ///< area of a square hole in each bulkhead, at the floor [m^2]
  bool has_rim = true;  ///< false: closed
};

inline HoldOpening squareOpening(const Vector3& middle, const Vector3& u, const Vector3& v,
                                 int to = -1) {
  HoldOpening opening;
  for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    const Vector3 corner = middle + 0.5 * a * u + 0.5 * b * v;
    opening.outline.insert(opening.outline.end(), corner.data(), corner.data() + 3);
  }
  opening.lid = {0, 1, 2, 0, 2, 3};
  opening.to = to;
  return opening;
}

/// docs/theory.md eq. (133) per mass: water in a closed box that turns across the sides a and b.
inline double turningOfBox(double a, double b) {
  const double r = std::max(a / b, b / a), per = r * (1 + r * r);
  const double share =
      1 - 4 / (1 + r * r) + 768 / std::pow(kPi, 5) * (std::tanh(kPi * r / 2) + 0.0045) / per;
  return (a * a + b * b) / 12 * share;
}

inline Hold boxHold(const Vector3& size, const Vector3& centre) {
  Hold hold;
  hold.name = "hold";
  const Triangulation box = boxMesh(size, 1);
  for (const Vector3& vertex : box.vertices) {
    const Vector3 place = centre + vertex;
    hold.surface.vertices.insert(hold.surface.vertices.end(), place.data(), place.data() + 3);
  }
  for (const auto& t : box.triangles)
    hold.surface.triangles.own().insert(hold.surface.triangles.end(), {t[0], t[1], t[2]});
  hold.volume = size.prod();
  hold.centre = centre;
  const Vector3 turning(turningOfBox(size.y(), size.z()), turningOfBox(size.z(), size.x()),
                        turningOfBox(size.x(), size.y()));
  hold.turning_inertia = (hold.volume * turning).asDiagonal();
  return hold;
}

inline FluidBody openBarge(const OpenBarge& barge = {}) {
  FluidBody body = floatingBox(barge.size, 1);
  body.name = "barge";
  const double t = barge.wall;
  const Vector3 inner((barge.size.x() - t) / barge.holds - t, barge.size.y() - 2 * t,
                      barge.size.z() - t);
  for (int i = 0; i < barge.holds; ++i) {
    const double x = -barge.size.x() / 2 + t + inner.x() / 2 + i * (inner.x() + t);
    const Vector3 centre(x, 0, t / 2);
    Hold hold = boxHold(inner, centre);
    const Vector3 up(0, 0, inner.z() / 2);
    const Vector3 along = inner.x() * Vector3::UnitX(), across = inner.y() * Vector3::UnitY();
    if (barge.has_rim) hold.openings.push_back(squareOpening(centre + up, along, across));
    const double hole = std::sqrt(barge.hole), door = std::sqrt(barge.door);
    if (hole > 0)
      hold.openings.push_back(
          squareOpening(centre - up, hole * Vector3::UnitY(), hole * Vector3::UnitX()));
    if (door > 0 && i + 1 < barge.holds)
      hold.openings.push_back(
          squareOpening(centre + Vector3(inner.x() / 2, 0, (door - inner.z()) / 2),
                        door * Vector3::UnitY(), door * Vector3::UnitZ(), i + 1));
    body.holds.push_back(hold);
  }
  makeSurfaceForm(body);
  return body;
}

/// Work that sealed air gives when it comes to the pressure outside at constant temperature,
/// docs/theory.md eq. (148) [J]. Never negative.
inline double energyOfAir(double product, double volume, double atmosphere) {
  if (!(product > 0)) return atmosphere * volume;
  return product * std::log(product / (volume * atmosphere)) + atmosphere * volume - product;
}

}  // namespace ambient::test
