#include "bullet_ambient/force/surface/hydrostatics.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/kernels/hull_sums.h"
#include "bullet_ambient/force/surface/wet_polygon.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

HullPlane planeOf(const SurfacePlane& plane, const PlaneAxes& axes) {
  const Vector3 &s = plane.normal, &e = axes.first, &f = axes.second;
  return {{s.x(), s.y(), s.z()}, {{e.x(), e.y(), e.z()}, {f.x(), f.y(), f.z()}}, plane.height};
}

Waterplane waterplaneOf(const HullSums& sums, const SurfacePlane& plane, const PlaneAxes& axes) {
  const double area = sums.area;
  if (!(area > 0)) return {};
  const double x = sums.first[0] / area, y = sums.first[1] / area;
  const double xx = std::max(0.0, sums.second[0] - area * x * x);
  const double yy = std::max(0.0, sums.second[2] - area * y * y);
  const double xy = sums.second[1] - area * x * y;
  const Vector3 &e = axes.first, &f = axes.second;
  return {area, plane.height * plane.normal + x * e + y * f,
          xx * e * e.transpose() + xy * (e * f.transpose() + f * e.transpose()) +
              yy * f * f.transpose()};
}

}  // namespace

WetVolume WetVolume::inB(const FrameOffset& frame) const {
  const Matrix3& R = frame.rotation;
  AMBIENT_ASSERT(isRotation(frame.rotation));
  return {volume,
          R * moment + volume * frame.translation,
          depth_integral,
          {waterplane.area, R * waterplane.centroid + frame.translation,
           R * waterplane.spread * R.transpose()}};
}

double hydrostaticEnergyChange(const WetVolume& wet, const SurfacePlane& plane,
                               const SurfacePlane& near) noexcept {
  const Waterplane& section = wet.waterplane;
  const Vector3 turn = near.normal - plane.normal;
  const double rise = near.height - plane.height;
  const double heave = rise - section.centroid.dot(turn);
  const double first = wet.volume * rise - wet.moment.dot(turn);
  const double second = section.area * heave * heave + turn.dot(section.spread * turn);
  return plane.density * plane.gravity * (first + second / 2);
}

WetVolume computeWetVolume(const PackedHull& hull, const SurfacePlane& plane) noexcept {
  AMBIENT_ASSERT(isUnit(plane.normal));
  const PlaneAxes axes(plane.normal);
  const HullSums sums = plane.sides_F
                            ? sumBetweenSides(hull.blocks(), plane)
                            : kHullKernels.fastest()->sums(hull.blocks(), planeOf(plane, axes));
  const Vector3 moment = sums.moment[0] * axes.first + sums.moment[1] * axes.second +
                         (plane.height * sums.volume - sums.depth) * plane.normal;
  const double factor = hull.volumeFactor();
  WetVolume wet{factor * sums.volume, factor * moment, factor * sums.depth,
                waterplaneOf(sums, plane, axes)};
  AMBIENT_ASSERT(factor > 0);
  AMBIENT_ASSERT(!(wet.waterplane.area < 0) && isSymmetric(wet.waterplane.spread, 1e-9));
  wet.waterplane.area *= factor;
  wet.waterplane.spread *= factor;
  return wet;
}

Wrench computeSidePush(const PackedHull& hull, const SurfacePlane& plane) noexcept {
  AMBIENT_ASSERT(isUnit(plane.normal) && plane.sides_F);
  return hull.volumeFactor() * plane.density * plane.gravity * sumOverSides(hull.blocks(), plane);
}

std::pair<double, double> computeExtent(const PackedHull& hull, const Vector3& s) noexcept {
  const HullExtent extent = kHullKernels.fastest()->extent(hull.corners(), {s.x(), s.y(), s.z()});
  return {extent.low, extent.high};
}

WetVolume computeWetSphere(double radius, const Vector3& centre,
                           const SurfacePlane& plane) noexcept {
  AMBIENT_ASSERT(radius > 0 && isUnit(plane.normal));
  const double depth = std::clamp(plane.depth(centre) + radius, 0.0, 2 * radius);
  const double volume = kPi * depth * depth * (3 * radius - depth) / 3;
  // First moment of the cap along s, about the sphere's centre:
  // V times -3 (2R - d)^2 / (4 (3R - d)).
  const double left = 2 * radius - depth;
  const double along = -kPi * depth * depth * left * left / 4;
  const double integral = plane.depth(centre) * volume - along;
  const double area = kPi * depth * left;
  const Vector3& s = plane.normal;
  WetVolume wet{volume, volume * centre + along * s, integral, {}};
  if (area > 0)
    wet.waterplane = {area, centre + plane.depth(centre) * s,
                      area * area / (4 * kPi) * (Matrix3::Identity() - s * s.transpose())};
  return wet;
}

}  // namespace ambient
