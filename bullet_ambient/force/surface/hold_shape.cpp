#include "bullet_ambient/force/surface/hold_shape.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

HoldFill fillHold(const HoldShape& shape, const Vector3& normal, double volume,
                  double guess) noexcept {
  constexpr double kEmpty = 1e-12, kAccuracy = 1e-12;  // of the hold
  constexpr int kMostClips = 60;                       // bisections alone need fewer
  const double capacity = shape.capacity();
  AMBIENT_ASSERT(isUnit(normal) && capacity > 0);
  auto [low, high] = computeExtent(shape.hull(), normal);
  HoldFill fill;
  const auto clip = [&](double height) {
    fill.height = height;
    fill.water = computeWetVolume(shape.hull(), {normal, height, 0, 0});
    ++fill.clips;
  };
  if (volume <= kEmpty * capacity || volume >= (1 - kEmpty) * capacity) {
    clip(volume <= kEmpty * capacity ? low : high);
    fill.water.waterplane = {};
    return fill;
  }
  double next = low < guess && guess < high ? guess : low + (high - low) * volume / capacity;
  while (fill.clips < kMostClips) {
    clip(next);
    const double error = fill.water.volume - volume;
    if (std::abs(error) <= kAccuracy * capacity) break;
    (error > 0 ? high : low) = next;
    const double area = fill.water.waterplane.area;
    next = area > 0 ? next - error / area : low;
    if (!(low < next && next < high)) next = (low + high) / 2;
  }
  if (fill.water.volume > 0) fill.water.moment *= volume / fill.water.volume;
  fill.water.volume = volume;
  return fill;
}

WetVolume withWaterInside(WetVolume wet, const SurfacePlane& plane, const HoldFill& fill) noexcept {
  const WetVolume& water = fill.water;
  wet.volume -= water.volume;
  wet.moment -= water.moment;
  wet.depth_integral += (fill.height - plane.height) * water.volume - water.depth_integral;
  return wet;
}

}  // namespace ambient
