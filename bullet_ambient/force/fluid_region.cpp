#include "bullet_ambient/force/fluid_region.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace ambient {
namespace {

[[noreturn]] void rejectRegion(const std::string& what, double value, const char* limit) {
  std::ostringstream sentence;
  sentence << what << " is " << value << "; must be " << limit;
  throw std::invalid_argument(sentence.str());
}

void checkRegionMedium(const Medium& medium, const std::string& which) {
  if (!(medium.density >= 0) || !std::isfinite(medium.density))
    rejectRegion("density " + which + " [kg/m^3]", medium.density, "zero or positive and finite");
  if (!(medium.viscosity >= 0) || !std::isfinite(medium.viscosity))
    rejectRegion("viscosity " + which + " [Pa s]", medium.viscosity, "zero or positive and finite");
  if (!medium.velocity.allFinite())
    rejectRegion("speed " + which + " [m/s]", medium.velocity.norm(), "finite");
  if (!medium.acceleration.allFinite())
    rejectRegion("acceleration " + which + " [m/s^2]", medium.acceleration.norm(), "finite");
}

void add(const FlowSample& flow, Medium& medium) {
  medium.velocity += flow.velocity;
  medium.acceleration += flow.acceleration;
}

// What it throws is taken for a sample that is not finite.
FlowSample sampleFlow(const FlowField& flow, const Vector3& point_W, double time) noexcept {
  try {
    return flow(point_W, time);
  } catch (...) {
    return {Vector3::Constant(std::numeric_limits<double>::quiet_NaN()), {0, 0, 0}};
  }
}

bool isFinite(const Medium& medium) {
  return medium.velocity.allFinite() && medium.acceleration.allFinite();
}

}  // namespace

bool RegionBounds::hold(const Vector3& point_W) const noexcept {
  return (point_W.array() >= lowest.array()).all() && (point_W.array() < highest.array()).all();
}

RegionSample sampleRegion(const FluidRegion& region, const Vector3& point_W, double time) noexcept {
  RegionSample sample{region.below, region.above, std::numeric_limits<double>::infinity()};
  bool is_finite = true;
  if (region.surface) {
    const WaterSample water = region.surface->sample(point_W, time);
    sample.height = water.height;
    is_finite = std::isfinite(water.height);
    add({water.velocity, water.acceleration}, sample.below);
  }
  if (region.flow) {
    const FlowSample flow = sampleFlow(region.flow, point_W, time);
    add(flow, sample.below);
    add(flow, sample.above);
  }
  if (is_finite && isFinite(sample.below) && isFinite(sample.above)) return sample;
  return {region.below, region.above, is_finite ? sample.height : 0, false};
}

void checkRegion(const FluidRegion& region) {
  if (region.bounds) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
      const double size = region.bounds->highest[axis] - region.bounds->lowest[axis];
      if (!(size > 0))
        rejectRegion(std::string("size along ") + kAxes[axis] + " [m]", size, "positive");
    }
  }
  checkRegionMedium(region.below, region.surface ? "below the surface" : "of the medium");
  if (region.surface) checkRegionMedium(region.above, "above the surface");
}

}  // namespace ambient
