#include "bullet_ambient/force/surface/hydrostatics.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/kernels/hull_sums.h"
#include "bullet_ambient/force/medium/profiles.h"
#include "bullet_ambient/force/surface/wet_polygon.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

HullPlane hullPlaneOf(const SurfacePlane& plane, const PlaneAxes& axes) {
  const Vector3 &s = plane.normal, &e = axes.first, &f = axes.second;
  return {{s.x(), s.y(), s.z()}, {{e.x(), e.y(), e.z()}, {f.x(), f.y(), f.z()}}, plane.height};
}

Waterplane waterhullPlaneOf(const HullSums& sums, const SurfacePlane& plane,
                            const PlaneAxes& axes) {
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
                            : kHullKernels.fastest()->sums(hull.blocks(), hullPlaneOf(plane, axes));
  const Vector3 moment = sums.moment[0] * axes.first + sums.moment[1] * axes.second +
                         (plane.height * sums.volume - sums.depth) * plane.normal;
  const double factor = hull.volumeFactor();
  WetVolume wet{factor * sums.volume, factor * moment, factor * sums.depth,
                waterhullPlaneOf(sums, plane, axes)};
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

namespace {

// Nodes and weights of Gauss on [0, 1], of degree 7.
constexpr double kNode[] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                            0.93056815579702629};
constexpr double kWeight[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                              0.17392742256872693};

// Excess of the fluid below one height after another.
class ExcessSum {
 public:
  explicit ExcessSum(const LayeredBody& body) : body_(body) {}

  void addAll(double density) noexcept {
    excess_.mass += density * body_.shape.volume;
    excess_.moment += density * body_.shape.volume * body_.shape.centre_of_volume;
  }
  /// Adds the moment of a density that grows evenly along `up` [kg/m^4].
  void addGrowth(double slope) noexcept {
    const Matrix3& inertia = body_.shape.uniform_mass.inertia;
    excess_.moment +=
        slope * body_.shape.volume * (inertia.trace() / 2 * body_.up - inertia * body_.up);
  }
  void addBelow(double height, double density) noexcept {
    SurfacePlane plane;
    plane.normal = body_.up;
    plane.height = height - body_.origin_height;
    const WetVolume wet = body_.hull ? computeWetVolume(*body_.hull, plane)
                                     : computeWetSphere(body_.shape.sphere_radius,
                                                        body_.shape.centre_of_volume, plane);
    excess_.mass += density * wet.volume;
    excess_.moment += density * wet.moment;
  }
  const ExcessFluid& result() const noexcept { return excess_; }

 private:
  const LayeredBody& body_;
  ExcessFluid excess_;
};

// Returns the lowest and the highest point of a body, as the layers count heights [m].
std::pair<double, double> heightsOf(const LayeredBody& body) noexcept {
  if (body.hull) {
    const auto [low, high] = computeExtent(*body.hull, body.up);
    return {body.origin_height + low, body.origin_height + high};
  }
  const double centre = body.origin_height + body.up.dot(body.shape.centre_of_volume);
  return {centre - body.shape.sphere_radius, centre + body.shape.sphere_radius};
}

// Returns the slope of the density between two heights [kg/m^4]; none: it bends there.
std::optional<double> slopeBetween(const DensityLayers& layers, double low, double high) noexcept {
  const auto& levels = layers.levels();
  if (high <= levels.front().height || low >= levels.back().height) return 0;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    if (low >= levels[i].height && high <= levels[i + 1].height && low < levels[i + 1].height)
      return (levels[i + 1].density - levels[i].density) /
             (levels[i + 1].height - levels[i].height);
  return std::nullopt;
}

bool knowsSpread(const LayeredBody& body) noexcept {
  return body.shape.uniform_mass.inertia.trace() > 0;
}

}  // namespace

ExcessFluid findExcessFluid(const LayeredBody& body, const DensityLayers& layers,
                            double reference) noexcept {
  const auto [low, high] = heightsOf(body);
  const double top = std::min(high, body.surface);
  const double middle = body.origin_height + body.up.dot(body.shape.centre_of_volume);
  ExcessSum sum(body);
  if (!(high > low)) sum.addAll(layers.density(std::min(middle, body.surface)) - reference);
  if (!(top > low)) return sum.result();
  if (const auto slope = slopeBetween(layers, low, high);
      slope && top == high && knowsSpread(body)) {
    sum.addAll(layers.density(middle) - reference);
    sum.addGrowth(*slope);
    return sum.result();
  }
  if (top < high)
    sum.addBelow(top, layers.density(top) - reference);
  else
    sum.addAll(layers.density(top) - reference);
  const auto& levels = layers.levels();
  for (std::size_t i = 0; i + 1 < levels.size() && levels[i].height < top; ++i) {
    const DensityLevel &from = levels[i], &to = levels[i + 1];
    const double fall = from.density - to.density, thickness = to.height - from.height;
    const double begin = std::max(low, from.height), end = std::min(top, to.height);
    if (fall == 0 || end < low) continue;
    if (!(thickness > 0)) {
      sum.addBelow(from.height, fall);
    } else if (end > begin) {
      for (int node = 0; node < 4; ++node)
        sum.addBelow(begin + kNode[node] * (end - begin),
                     kWeight[node] * fall * ((end - begin) / thickness));
    }
  }
  return sum.result();
}

}  // namespace ambient
