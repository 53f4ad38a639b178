#pragma once

#include <limits>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {

inline constexpr double kFar = std::numeric_limits<double>::infinity();
inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

inline BodyDef tumblingBody(const Vector3& position) {
  BodyDef def{2, ellipsoidMoments(kUnequalAxes, 2), {}, nullptr};
  def.start.position = position;
  def.start.twist = {Vector3(1, 2, 3), Vector3(2, 0, 1)};
  return def;
}

inline FluidRegion filledWith(const Medium& medium) {
  FluidRegion region;
  region.below = medium;
  return region;
}

inline FluidRegion halfSpace(int axis, double from, const Medium& medium) {
  FluidRegion region = filledWith(medium);
  region.bounds = RegionBounds{Vector3::Constant(-kFar), Vector3::Constant(kFar)};
  region.bounds->lowest[axis] = from;
  return region;
}

}  // namespace ambient::test
