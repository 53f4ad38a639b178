#include "bullet_ambient/force/medium/waves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

// Laws of waves on deep water, checked by differences between samples.

constexpr double kWaveGravity = 9.7;

CalmSea slantedSea() {
  CalmSea sea;
  sea.level = 0.4;
  sea.up = {0.6, 0, 0.8};
  sea.gravity = kWaveGravity;
  return sea;
}

std::vector<WaveComponent> threeWaves() {
  return {
      {0.02, 3.0, {1, 0.4, 0.1}, 0.3}, {0.01, 2.1, {-0.3, 1, 0}, 2}, {0.005, 1.3, {0, 1, 1}, -1}};
}

const Vector3 kUnderWater(1.3, -0.7, -1.2);
constexpr double kSomeTime = 4.7, kDifference = 1e-5;

Vector3 unitUp() { return {0.6, 0, 0.8}; }

// Point of the mean surface at a distance along the wave.
Vector3 onMeanLevel(double along) { return 0.4 * unitUp() + along * Vector3(0.8, 0, -0.6); }

TEST(AiryWaves, AreAsLongAsDeepWaterMakesThem) {
  const double period = 2.5, omega = 2 * kPi / period;
  const double length = kWaveGravity * period * period / (2 * kPi);  // g T^2 / 2 pi
  const AiryWaves waves(slantedSea(), {{0.1, period, {0.8, 0, -0.6}, 0.2}});
  for (const double along : {0.0, 1.1, 3.0}) {
    const WaterSample here = waves.sample(onMeanLevel(along), kSomeTime);
    EXPECT_NEAR(waves.sample(onMeanLevel(along + length), kSomeTime).height, here.height, 1e-12);
    EXPECT_NEAR(waves.sample(onMeanLevel(along), kSomeTime + period).height, here.height, 1e-12);
    // Crests travel along the wave's direction.
    const double later = kSomeTime + 0.1;
    EXPECT_NEAR(waves.sample(onMeanLevel(along + 0.1 * length / period), later).height, here.height,
                1e-12);
    EXPECT_NEAR(here.height,
                0.1 * std::cos(omega * omega / kWaveGravity * along - omega * kSomeTime + 0.2),
                1e-12);
  }
}

TEST(AiryWaves, AccelerationIsTheRateOfChangeOfVelocity) {
  const AiryWaves waves(slantedSea(), threeWaves());
  for (const double depth : {0.0, 0.3, 2.0}) {
    const Vector3 point = onMeanLevel(1.1) - depth * unitUp();
    const Vector3 difference = waves.sample(point, kSomeTime + kDifference).velocity -
                               waves.sample(point, kSomeTime - kDifference).velocity;
    const Vector3 expected = difference / (2 * kDifference);
    EXPECT_LT((waves.sample(point, kSomeTime).acceleration - expected).norm(),
              1e-8 * expected.norm());
  }
}

TEST(AiryWaves, VelocityIsSolenoidalAndIrrotational) {
  const AiryWaves waves(slantedSea(), threeWaves());
  Matrix3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 step = kDifference * Vector3::Unit(axis);
    gradient.col(axis) = (waves.sample(kUnderWater + step, kSomeTime).velocity -
                          waves.sample(kUnderWater - step, kSomeTime).velocity) /
                         (2 * kDifference);
  }
  const double size = gradient.norm();
  EXPECT_GT(size, 1e-3);
  EXPECT_NEAR(gradient.trace(), 0, 1e-8 * size);
  EXPECT_LT((gradient - gradient.transpose()).norm(), 1e-8 * size);
}

TEST(AiryWaves, SurfaceMovesWithTheWater) {
  const AiryWaves waves(slantedSea(), threeWaves());
  const Vector3 point = onMeanLevel(2.2);
  const double rate = (waves.sample(point, kSomeTime + kDifference).height -
                       waves.sample(point, kSomeTime - kDifference).height) /
                      (2 * kDifference);
  EXPECT_NEAR(rate, unitUp().dot(waves.sample(point, kSomeTime).velocity), 1e-9);
}

// g - u' has no component along the surface to first order in the slope. The second-order residual
// must fall by four when the amplitude is halved.
TEST(AiryWaves, EffectiveGravityIsNormalToTheSurfaceToFirstOrder) {
  const auto tilt = [](double amplitude) {
    const AiryWaves waves(slantedSea(), {{amplitude, 2.0, {0.8, 0, -0.6}, 0}});
    const Vector3 point = onMeanLevel(0.9);
    const Vector3 along = kDifference * Vector3(0.8, 0, -0.6);
    const double slope =
        (waves.sample(point + along, 0).height - waves.sample(point - along, 0).height) /
        (2 * kDifference);
    const Vector3 normal = (unitUp() - slope * Vector3(0.8, 0, -0.6)).normalized();
    const Vector3 gravity = -kWaveGravity * unitUp() - waves.sample(point, 0).acceleration;
    return (gravity.normalized() + normal).norm();
  };
  EXPECT_GT(tilt(0.1), 0);
  EXPECT_NEAR(tilt(0.05) / tilt(0.1), 0.25, 0.02);
  EXPECT_LT(tilt(0.05), 0.01);
}

TEST(AiryWaves, FadeWithDepthAndNotAboveTheLevel) {
  const double period = 2, k = 4 * kPi * kPi / (period * period) / kWaveGravity;
  const AiryWaves waves(slantedSea(), {{0.1, period, {0, 1, 0}, 0.4}});
  const double top = waves.sample(onMeanLevel(0), 0).velocity.norm();
  EXPECT_NEAR(top, 0.1 * 2 * kPi / period, 1e-14);
  EXPECT_NEAR(waves.sample(onMeanLevel(0) - unitUp(), 0).velocity.norm(), top * std::exp(-k),
              1e-14);
  EXPECT_EQ(waves.sample(onMeanLevel(0) + 3 * unitUp(), 0).velocity.norm(), top);
}

TEST(AiryWaves, RideOnTheCurrent) {
  CalmSea sea = slantedSea();
  const AiryWaves still(sea, threeWaves());
  sea.current = {0.8, 0.5, -0.6};
  const AiryWaves carried(sea, threeWaves());
  const WaterSample a = still.sample(kUnderWater, kSomeTime);
  const WaterSample b = carried.sample(kUnderWater + kSomeTime * sea.current, kSomeTime);
  EXPECT_NEAR(b.height, a.height, 1e-13);
  EXPECT_LT((b.velocity - a.velocity - sea.current).norm(), 1e-13);
  EXPECT_LT((b.acceleration - a.acceleration).norm(), 1e-13);
}

TEST(StillWater, IsAPlane) {
  const StillWater water(2, {0, 3, 0});
  EXPECT_TRUE(water.isStill());
  EXPECT_EQ(water.sample({7, 0.5, -1}, 3).height, 1.5);
  EXPECT_EQ(water.sample({7, 3, -1}, 3).height, -1);
  EXPECT_TRUE(water.sample({7, 3, -1}, 3).velocity.isZero(0));
}

TEST(WaterSurfaceFunction, SaysWhatTheFunctionSays) {
  const WaterSurfaceFunction water([](const Vector3& point, double time) {
    return WaterSample{time - point.x(), {1, 0, 0}, {0, 1, 0}};
  });
  EXPECT_FALSE(water.isStill());
  EXPECT_EQ(water.sample({1, 0, 0}, 3).height, 2);
  EXPECT_EQ(water.sample({1, 0, 0}, 3).acceleration.y(), 1);
}

std::string seaError(const CalmSea& sea, const std::vector<WaveComponent>& waves) {
  return test::refusalOf<std::invalid_argument>([&] { AiryWaves made(sea, waves); });
}

TEST(AiryWaves, SayWhatIsWrong) {
  const CalmSea sea;
  EXPECT_EQ(seaError(sea, {{}, {-1, 2, {1, 0, 0}, 0}}),
            "amplitude [m] of wave 1 is -1; must be zero or positive and finite");
  EXPECT_EQ(seaError(sea, {{1, 0, {1, 0, 0}, 0}}),
            "period [s] of wave 0 is 0; must be positive and finite");
  EXPECT_EQ(seaError(sea, {{1, 1, {0, 0, 2}, 0}}),
            "horizontal part of the direction of wave 0 is 0; must be positive and finite");
  EXPECT_NE(seaError(sea, {{0.1, 0.5, {1, 0, 0}, 0}}).find("; must be at most 1"),
            std::string::npos);  // 0.1 (2 pi / 0.5)^2 / 9.81 = 1.61
  CalmSea odd;
  odd.gravity = 0;
  EXPECT_EQ(seaError(odd, {}), "gravity of the sea [m/s^2] is 0; must be positive and finite");
  odd.up.setZero();
  EXPECT_EQ(seaError(odd, {}), "the direction up of the water has no length, or is not finite");
}

WaveSpectrum northSea(double enhancement, int components) {
  WaveSpectrum spectrum;
  spectrum.significant_height = 2.4;
  spectrum.peak_period = 8;
  spectrum.peak_enhancement = enhancement;
  spectrum.components = components;
  return spectrum;
}

double frequencyOf(const WaveComponent& wave) { return 2 * kPi / wave.period; }

TEST(WaveSpectrum, HasTheEnergyOfItsSignificantHeight) {
  for (const double gamma : {1.0, 3.3, 7.0}) {
    double variance = 0;
    for (const WaveComponent& wave : wavesOf(northSea(gamma, 37)))
      variance += wave.amplitude * wave.amplitude / 2;
    EXPECT_NEAR(variance, 2.4 * 2.4 / 16, 1e-13);
  }
}

TEST(WaveSpectrum, OfAFullyDevelopedSeaHasItsClosedForm) {
  // Pierson and Moskowitz: the energy below omega is exp(-5/4 (omega_p / omega)^4) of the total.
  const auto waves = wavesOf(northSea(1, 40));
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double ratio = 8 / waves[i].period;
    EXPECT_NEAR(std::exp(-1.25 * std::pow(ratio, -4)), (static_cast<double>(i) + 0.5) / 40, 1e-12);
  }
  // Mean frequency of the spectrum: (5/4)^(1/4) Gamma(3/4) omega_p.
  const auto many = wavesOf(northSea(1, 20000));
  const double mean = std::accumulate(
      many.begin(), many.end(), 0.0,
      [](double sum, const WaveComponent& wave) { return sum + frequencyOf(wave) / 20000; });
  EXPECT_NEAR(mean, std::pow(1.25, 0.25) * std::tgamma(0.75) * 2 * kPi / 8, 2e-4);
}

// S(omega) of Hasselmann et al. (1973) up to a factor, with omega in omega_p.
double jonswap(double ratio, double gamma) {
  const double sigma = ratio <= 1 ? 0.07 : 0.09;
  const double peak = std::exp(-std::pow((ratio - 1) / sigma, 2) / 2);
  return std::pow(ratio, -5) * std::exp(-1.25 * std::pow(ratio, -4)) * std::pow(gamma, peak);
}

double energyBetween(double from, double to, double gamma) {
  constexpr int kSteps = 100000;
  const double step = (to - from) / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += step * jonswap(from + (i + 0.5) * step, gamma);
  return sum;
}

TEST(WaveSpectrum, DividesTheEnergyIntoEqualParts) {
  constexpr double kLow = 0.2, kHigh = 40;  // leaves out 1e-20 and 1e-7 of the energy
  for (const double gamma : {2.0, 3.3, 7.0}) {
    const double all = energyBetween(kLow, kHigh, gamma);
    const auto waves = wavesOf(northSea(gamma, 25));
    for (std::size_t i = 0; i < waves.size(); ++i)
      EXPECT_NEAR(energyBetween(kLow, 8 / waves[i].period, gamma) / all,
                  (static_cast<double>(i) + 0.5) / 25, 1e-5);
  }
}

TEST(WaveSpectrum, IsDensestAtItsPeak) {
  const auto waves = wavesOf(northSea(3.3, 1000));
  std::vector<double> gaps;
  for (std::size_t i = 0; i + 1 < waves.size(); ++i)
    gaps.push_back(frequencyOf(waves[i + 1]) - frequencyOf(waves[i]));
  const auto narrowest =
      static_cast<std::size_t>(std::min_element(gaps.begin(), gaps.end()) - gaps.begin());
  EXPECT_NEAR(waves[narrowest].period, 8, 0.05);
}

TEST(WaveSpectrum, MakesASeaOfItsSignificantHeight) {
  const AiryWaves sea({}, wavesOf(northSea(3.3, 50)));
  double sum = 0, squares = 0;
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const double height = sea.sample({0, 0, 0}, 0.73 * i).height;
    sum += height / kSamples;
    squares += height * height / kSamples;
  }
  EXPECT_NEAR(sum, 0, 0.01);
  EXPECT_NEAR(4 * std::sqrt(squares), 2.4, 0.02);
}

TEST(WaveSpectrum, HasThePhasesOfItsSeed) {
  WaveSpectrum spectrum = northSea(3.3, 8);
  const auto first = wavesOf(spectrum), again = wavesOf(spectrum);
  spectrum.seed = 2;
  const auto other = wavesOf(spectrum);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].phase, again[i].phase);
    EXPECT_NE(first[i].phase, other[i].phase);
    EXPECT_EQ(first[i].period, other[i].period);
    EXPECT_GE(first[i].phase, 0);
    EXPECT_LT(first[i].phase, 2 * kPi);
  }
}

std::string complaintAbout(const WaveSpectrum& spectrum) {
  return test::refusalOf<std::invalid_argument>([&] { wavesOf(spectrum); });
}

TEST(WaveSpectrum, RefusesWhatIsNoSea) {
  WaveSpectrum spectrum = northSea(3.3, 0);
  EXPECT_EQ(complaintAbout(spectrum),
            "spectrum of waves: number of components is 0; must be between 1 and 100000");
  spectrum = northSea(0.5, 10);
  EXPECT_EQ(complaintAbout(spectrum),
            "spectrum of waves: peak enhancement is 0.5; must be at least 1 and finite");
  spectrum = northSea(3.3, 10);
  spectrum.peak_period = 0;
  EXPECT_EQ(complaintAbout(spectrum),
            "spectrum of waves: peak period [s] is 0; must be positive and finite");
  spectrum = northSea(3.3, 10);
  spectrum.significant_height = HUGE_VAL;
  EXPECT_EQ(
      complaintAbout(spectrum),
      "spectrum of waves: significant height [m] is inf; must be zero or positive and finite");
}

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
