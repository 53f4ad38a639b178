#include "bullet_ambient/force/medium/fluid_region.h"

#include <cmath>
#include <limits>
#include <string>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/medium/input_checks.h"
#include "bullet_ambient/force/medium/medium.h"

namespace ambient {
namespace {

void checkRegionMedium(const Medium& medium, const std::string& which) {
  if (const auto fault = faultOf(medium))
    InputChecks{}.require(false,
                          std::string(fault->quantity) + " " + which + " [" + fault->unit + "]",
                          fault->value, fault->limit);
}

// Bits of BareVelocity::parts.
constexpr unsigned kMedium = 1, kWaves = 2, kFlow = 4;

// Adds a flow to a medium, whose velocity carries the flow along, docs/theory.md eq. (172).
void add(unsigned part, const FlowSample& flow, Medium& medium, BareVelocity& bare) {
  Vector3 acceleration = flow.acceleration;
  if (!flow.gradient.isZero(0)) acceleration += flow.gradient * medium.velocity;
  medium.velocity += flow.velocity;
  medium.acceleration += acceleration;
  bare.add(part, flow.velocity, acceleration);
}

// An exception of the function counts as a sample that is not finite.
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

// Returns how far the middle of the dry height of a body is above the point of a sample [m].
double riseToDryMiddle(const RegionSample& sample, double half_height) {
  return std::abs(sample.height) < half_height ? (half_height + sample.height) / 2 : 0;
}

void addFlow(const FluidRegion& region, const Vector3& point_W, double time, double half_height,
             RegionSample& sample) noexcept {
  FlowSample above;
  if (region.flow) {
    const FlowSample flow = sampleFlow(region.flow, point_W, time);
    add(kFlow, flow, sample.below, sample.bare_below);
    if (!region.flow_above) add(kFlow, flow, sample.above, sample.bare_above);
    above = flow;
  }
  if (!region.flow_above || !region.surface) return;
  const Vector3 up = region.surface->up();
  const Vector3 raised = point_W + riseToDryMiddle(sample, half_height) * up;
  add(kFlow, sumOf(above, sampleFlow(region.flow_above, raised, time)), sample.above,
      sample.bare_above);
}

}  // namespace

bool RegionBounds::hold(const Vector3& point_W) const noexcept {
  return (point_W.array() >= lowest.array()).all() && (point_W.array() < highest.array()).all();
}

FluidRegion waterBelow(double level) {
  FluidRegion region;
  region.below = water();
  region.surface = std::make_shared<StillWater>(level, Vector3(0, 0, 1));
  return region;
}

FluidRegion windZone(const RegionBounds& bounds, const Vector3& velocity) {
  FluidRegion region;
  region.bounds = bounds;
  region.below = air();
  region.below.velocity = velocity;
  return region;
}

Medium unnamedAbove(double water_density, const Medium& own) {
  return own.density > 0 && own.density < water_density ? own : air();
}

BareVelocity bareVelocityOf(const Medium& medium) noexcept {
  BareVelocity bare;
  bare.add(kMedium, medium.velocity, medium.acceleration);
  return bare;
}

FlowSample sumOf(const FlowSample& a, const FlowSample& b) noexcept {
  FlowSample sum{a.velocity + b.velocity, a.acceleration + b.acceleration, a.gradient + b.gradient};
  if (!a.gradient.isZero(0)) sum.acceleration += a.gradient * b.velocity;
  if (!b.gradient.isZero(0)) sum.acceleration += b.gradient * a.velocity;
  return sum;
}

RegionSample sampleRegion(const FluidRegion& region, const Vector3& point_W, double time,
                          const Medium& own, double half_height) noexcept {
  AMBIENT_ASSERT(isFinite(region.below));
  const Medium above = region.above.value_or(unnamedAbove(region.below.density, own));
  RegionSample sample{region.below, above, std::numeric_limits<double>::infinity()};
  sample.bare_below = bareVelocityOf(region.below);
  sample.bare_above = bareVelocityOf(above);
  bool is_finite = true;
  if (region.surface) {
    const WaterSample water = region.surface->sample(point_W, time);
    sample.height = water.height;
    is_finite = std::isfinite(water.height);
    add(kWaves, {water.velocity, water.acceleration}, sample.below, sample.bare_below);
  }
  if (hasFlow(region)) addFlow(region, point_W, time, half_height, sample);
  if (is_finite && isFinite(sample.below) && isFinite(sample.above)) return sample;
  return {region.below, above, is_finite ? sample.height : 0, false};
}

void checkRegion(const FluidRegion& region) {
  const InputChecks check;
  if (region.bounds) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
      const double size = region.bounds->highest[axis] - region.bounds->lowest[axis];
      check.require(size > 0, std::string("size along ") + kAxes[axis] + " [m]", size, "positive");
    }
  }
  check.require(!region.layers || region.below.density > 0,
                "density that added mass has in layers [kg/m^3]", region.below.density,
                "positive: set FluidRegion::below");
  checkRegionMedium(region.below, region.surface ? "below the surface" : "of the medium");
  if (!region.surface) return;
  check.require(region.below.density > 0, "density below the surface [kg/m^3]",
                region.below.density, "positive: set FluidRegion::below, say to water()");
  if (region.above) checkRegionMedium(*region.above, "above the surface");
}

std::optional<NumberFault> faultOf(const Medium& medium) noexcept {
  constexpr const char* kNotNegative = "zero or positive and finite";
  const auto is_wrong = [](double value) { return !(value >= 0) || !std::isfinite(value); };
  if (is_wrong(medium.density))
    return NumberFault{"density", "kg/m^3", medium.density, kNotNegative};
  constexpr double kStiffest = 1e24;  // the mantle has some 1e21
  if (!(medium.viscosity >= 0) || !(medium.viscosity <= kStiffest))
    return NumberFault{"viscosity", "Pa s", medium.viscosity, "from 0 to 1e24"};
  if (!medium.velocity.allFinite())
    return NumberFault{"speed", "m/s", medium.velocity.norm(), "finite"};
  if (!medium.acceleration.allFinite())
    return NumberFault{"acceleration", "m/s^2", medium.acceleration.norm(), "finite"};
  return {};
}

}  // namespace ambient
