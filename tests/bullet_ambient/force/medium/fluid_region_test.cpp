#include "bullet_ambient/force/medium/fluid_region.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "bullet_ambient/force/medium/waves.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

TEST(RegionBounds, SideBySideLeaveNoGap) {
  const RegionBounds left{{-1, -1, -1}, {0, 1, 1}}, right{{0, -1, -1}, {1, 1, 1}};
  EXPECT_TRUE(right.hold({0, 0, 0}));
  EXPECT_FALSE(left.hold({0, 0, 0}));
  EXPECT_TRUE(left.hold({-1, -1, -1}));
  EXPECT_FALSE(right.hold({0.5, 0.5, 1}));
  EXPECT_FALSE(right.hold({0.5, std::numeric_limits<double>::quiet_NaN(), 0}));
}

TEST(FluidRegion, AddsFlowAndWavesToItsMedium) {
  FluidRegion region;
  region.below = {900, 0.1, {1, 0, 0}, {0, 0, 1}};
  region.above = {1.2, 1e-5, {0, 4, 0}, {0, 0, 0}};
  region.flow = [](const Vector3& point, double time) {
    return FlowSample{{point.x(), 0, 0}, {0, time, 0}};
  };
  region.surface = std::make_shared<WaterSurfaceFunction>([](const Vector3& point, double) {
    return WaterSample{-point.z(), {0, 0, 3}, {5, 0, 0}};
  });
  const RegionSample wet = sampleRegion(region, {7, 0, -1}, 2);
  EXPECT_FALSE(wet.isAbove());
  EXPECT_EQ(wet.here().density, 900);
  EXPECT_EQ(wet.here().velocity, Vector3(8, 0, 3));
  EXPECT_EQ(wet.here().acceleration, Vector3(5, 2, 1));
  const RegionSample dry = sampleRegion(region, {7, 0, 1}, 2);
  EXPECT_TRUE(dry.isAbove());
  EXPECT_EQ(dry.here().density, 1.2);
  EXPECT_EQ(dry.here().velocity, Vector3(7, 4, 0));
  EXPECT_EQ(dry.here().acceleration, Vector3(0, 2, 0));
  region.surface = nullptr;
  EXPECT_FALSE(sampleRegion(region, {7, 0, 1}, 2).isAbove());
}

TEST(FluidRegion, KeepsItsMediumWhereFunctionsAreNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  FluidRegion region;
  region.below.velocity = {3, 0, 0};
  EXPECT_TRUE(sampleRegion(region, {0, 0, 0}, 0).is_finite);
  for (const FlowSample& bad : {FlowSample{{kNan, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, kNan, 0}}}) {
    region.flow = [=](const Vector3&, double) { return bad; };
    EXPECT_FALSE(sampleRegion(region, {0, 0, 0}, 0).is_finite);
    EXPECT_EQ(sampleRegion(region, {0, 0, 0}, 0).here().velocity, Vector3(3, 0, 0));
  }
  region.flow = nullptr;
  region.surface = std::make_shared<WaterSurfaceFunction>([](const Vector3&, double) {
    return WaterSample{kNan, {0, 0, 0}, {0, 0, 0}};
  });
  EXPECT_FALSE(sampleRegion(region, {0, 0, 0}, 0).is_finite);
}

TEST(FluidRegion, TakesWhatFunctionsThrowForNotFinite) {
  FluidRegion region;
  region.below.velocity = {3, 0, 0};
  region.flow = [](const Vector3&, double) -> FlowSample { throw std::runtime_error("no data"); };
  EXPECT_FALSE(sampleRegion(region, {0, 0, 0}, 0).is_finite);
  EXPECT_EQ(sampleRegion(region, {0, 0, 0}, 0).here().velocity, Vector3(3, 0, 0));
  region.flow = nullptr;
  region.surface = std::make_shared<WaterSurfaceFunction>(
      [](const Vector3&, double) -> WaterSample { throw 42; });
  EXPECT_FALSE(sampleRegion(region, {0, 0, 0}, 0).is_finite);
  EXPECT_THROW(WaterSurfaceFunction(nullptr), std::invalid_argument);
}

TEST(FluidRegion, IsSteadyWithoutFunctionsAndMovingSurfaces) {
  FluidRegion region;
  EXPECT_TRUE(isSteady(region));
  region.surface = std::make_shared<StillWater>(0, Vector3(0, 0, 1));
  EXPECT_TRUE(isSteady(region));
  region.surface = std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{});
  EXPECT_FALSE(isSteady(region));
  region.surface = nullptr;
  region.flow = [](const Vector3&, double) { return FlowSample{}; };
  EXPECT_FALSE(isSteady(region));
}

std::string regionError(const FluidRegion& region) {
  return test::refusalOf<std::invalid_argument>([&] { checkRegion(region); });
}

TEST(FluidRegion, SaysWhatIsWrong) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FluidRegion region;
  region.bounds = RegionBounds{{-kInfinity, 0, 0}, {kInfinity, 1, 2}};
  EXPECT_EQ(regionError(region), "");
  region.bounds->lowest.y() = 1.5;
  EXPECT_EQ(regionError(region), "size along y [m] is -0.5; must be positive");
  region.bounds.reset();
  region.below.density = -1;
  EXPECT_EQ(regionError(region),
            "density of the medium [kg/m^3] is -1; must be zero or positive and "
            "finite");
  region.below.density = 1;
  region.above = air();
  region.above->viscosity = kInfinity;
  EXPECT_EQ(regionError(region), "");  // there is nothing above
  region.surface = std::make_shared<StillWater>(0, Vector3(0, 0, 1));
  EXPECT_EQ(regionError(region),
            "viscosity above the surface [Pa s] is inf; must be from 0 to 1e24");
  region.below = {};
  EXPECT_EQ(regionError(region),
            "density below the surface [kg/m^3] is 0; must be positive: set FluidRegion::below, "
            "say to water()");
}

TEST(FluidRegion, UnnamedAboveIsTheOwnMediumOrAir) {
  FluidRegion region;
  region.below = water();
  region.surface = std::make_shared<StillWater>(0, Vector3(0, 0, 1));
  const auto densityAbove = [&](const Medium& own) {
    return sampleRegion(region, {0, 0, 1}, 0, own).here().density;
  };
  Medium helium = air();
  helium.density = 0.17;
  EXPECT_EQ(densityAbove(helium), 0.17);
  EXPECT_EQ(densityAbove(Medium{}), air().density);
  EXPECT_EQ(densityAbove(water()), air().density) << "no surface between water and water";
  region.above = Medium{};
  EXPECT_EQ(densityAbove(helium), 0) << "a vacuum that is asked for";
}

}  // namespace
}  // namespace ambient::test
