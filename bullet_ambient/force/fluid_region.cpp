#include "bullet_ambient/force/fluid_region.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace ambient {
namespace {

[[noreturn]] void rejectRegion(const std::string& what, double value, const char* limit) {
  std::ostringstream sentence;
  sentence << "region of fluid: " << what << " is " << value << "; must be " << limit;
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

}  // namespace

RegionMedium mediumAt(const FluidRegion& region, const Vector3& point_W, double time) noexcept {
  WaterSample water;
  if (region.surface) water = region.surface->sample(point_W, time);
  const bool is_above = region.surface && !(water.height > 0);
  const Medium& still = is_above ? region.above : region.below;
  RegionMedium here{still, is_above, std::isfinite(water.height)};
  Medium& medium = here.medium;
  if (!is_above) {
    medium.velocity += water.velocity;
    medium.acceleration += water.acceleration;
  }
  if (region.flow) {
    const FlowSample flow = region.flow(point_W, time);
    medium.velocity += flow.velocity;
    medium.acceleration += flow.acceleration;
  }
  here.is_finite = here.is_finite && medium.velocity.allFinite() && medium.acceleration.allFinite();
  if (!here.is_finite) medium = still;
  return here;
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
