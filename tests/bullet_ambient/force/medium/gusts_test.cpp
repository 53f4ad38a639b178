#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/wind.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/refusal_of.h"

// Flows and densities that regions take, docs/theory.md section 23.
namespace ambient::test {
namespace {

// Mean of samples, and the standard deviation of that mean.
class GustMean {
 public:
  void add(double sample) {
    ++count_;
    sum_ += sample;
    squares_ += sample * sample;
  }
  double mean() const { return sum_ / count_; }
  double sigma() const { return std::sqrt((squares_ / count_ - mean() * mean()) / count_); }

 private:
  double count_ = 0, sum_ = 0, squares_ = 0;
};

constexpr int kSeeds = 600;

// Expects a closed form within three standard deviations and the share of the energy that bands and
// the cut-off change, 0.01.
void expectWithin3Sigma(const GustMean& found, double expected, double variance) {
  EXPECT_NEAR(found.mean(), expected, 3 * found.sigma() + 0.01 * variance);
}

DrydenGusts strongGusts(std::uint64_t seed = 1) {
  DrydenGusts gusts;
  gusts.height = 50;
  gusts.speed = 20;
  gusts.intensity = 1.5;
  gusts.direction = {0, 2, 0.3};
  gusts.seed = seed;
  return gusts;
}

// Correlations are the transforms of the spectra (175): exp(-s), and (1 - s/2) exp(-s) across the
// wind, of s = V t / L.
TEST(DrydenGusts, HaveTheirVarianceAndCorrelation) {
  const DrydenScales scales = drydenScales(strongGusts());
  const Vector3 axes[] = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i)
    for (const double s : {0.0, 0.1, 0.5, 1.0, 3.0}) {
      SCOPED_TRACE(std::to_string(i) + ", " + std::to_string(s));
      const double later = s * scales.lengths[i] / strongGusts().speed;
      const double variance = scales.intensities[i] * scales.intensities[i];
      GustMean product;
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const FlowField gusts = drydenGusts(strongGusts(seed));
        for (const double time : {0.0, 517.0, 4099.0})
          product.add(axes[i].dot(gusts({0, 0, 0}, time).velocity) *
                      axes[i].dot(gusts({0, 0, 0}, time + later).velocity));
      }
      expectWithin3Sigma(product, variance * (i == 0 ? 1 : 1 - s / 2) * std::exp(-s), variance);
    }
}

TEST(GaussMarkovGusts, HaveTheirVarianceAndCorrelation) {
  const Vector3 intensity(0, 0.5, 2);
  for (const double s : {0.0, 0.1, 0.5, 1.0, 3.0}) {
    SCOPED_TRACE(s);
    std::array<GustMean, 3> products;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const FlowField gusts = gaussMarkovGusts({intensity, 0.7, seed});
      for (const double time : {0.0, 517.0, 4099.0}) {
        const Vector3 now = gusts({0, 0, 0}, time).velocity;
        const Vector3 later = gusts({0, 0, 0}, time + s * 0.7).velocity;
        for (int i = 0; i < 3; ++i) products[static_cast<std::size_t>(i)].add(now[i] * later[i]);
      }
    }
    for (int i = 0; i < 3; ++i) {
      const double variance = intensity[i] * intensity[i];
      expectWithin3Sigma(products[static_cast<std::size_t>(i)], variance * std::exp(-s), variance);
    }
  }
}

// Numbers of MIL-F-8785C, figures 10 and 11, by their formulas; at 1000 ft both pieces meet.
TEST(DrydenGusts, HaveTheScalesOfTheSpecification) {
  DrydenGusts gusts = strongGusts();
  gusts.height = 500 * 0.3048;
  const double near = 0.177 + 0.000823 * 500;
  EXPECT_NEAR(drydenScales(gusts).lengths.x(), gusts.height / std::pow(near, 1.2), 1e-9);
  EXPECT_NEAR(drydenScales(gusts).intensities.y(), 1.5 / std::pow(near, 0.4), 1e-12);
  EXPECT_EQ(drydenScales(gusts).lengths.z(), gusts.height);
  gusts.height = 304.8;
  EXPECT_NEAR(drydenScales(gusts).lengths.x(), 304.8, 1e-9);
  gusts.height = 999.9 * 0.3048;
  EXPECT_NEAR(drydenScales(gusts).lengths.x(), 304.8, 0.1);
  gusts.height = 3000;
  EXPECT_NEAR(drydenScales(gusts).lengths.z(), 533.4, 1e-9);
}

// Difference of the velocity along the way of a particle that the flow carries.
Vector3 changeAlong(const FlowField& flow, const Vector3& point, double time) {
  constexpr double kStep = 1e-5;
  const Vector3 way = kStep * flow(point, time).velocity;
  return (flow(point + way, time + kStep).velocity - flow(point - way, time - kStep).velocity) /
         (2 * kStep);
}

Matrix3 gradientBy(const FlowField& flow, const Vector3& point, double time) {
  constexpr double kStep = 1e-5;
  Matrix3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 way = kStep * Vector3::Unit(axis);
    gradient.col(axis) =
        (flow(point + way, time).velocity - flow(point - way, time).velocity) / (2 * kStep);
  }
  return gradient;
}

Turbulence carriedTurbulence(std::uint64_t seed = 1) {
  Turbulence eddies;
  eddies.length = 10;
  eddies.intensity = 2;
  eddies.carried = {3, -1, 0.2};
  eddies.seed = seed;
  return eddies;
}

std::vector<FlowField> allFlows() {
  WindProfile log, power;
  log.velocity = power.velocity = {4, 3, 7};
  log.up = {0, 0, 2};
  power.roughness = 0;
  const FlowField eddies = turbulence(carriedTurbulence());
  return {windProfile(log),
          windProfile(power),
          currentProfile({{0, {1, 0, 0}}, {3, {0, 2, 0}}, {8, {0, 0, 0}}}, 10),
          discreteGust({{1, 2, 3}, 0.3, 1.1, 0.4}),
          drydenGusts(strongGusts()),
          gaussMarkovGusts({{1, 2, 3}, 0.5}),
          eddies,
          windProfile(log) + eddies,
          eddies + windProfile(power) + discreteGust({{1, 2, 3}, 0.3, 1.1, 0.4})};
}

TEST(Flows, TellTheirExactAccelerationAndGradient) {
  const std::vector<FlowField> flows = allFlows();
  for (std::size_t i = 0; i < flows.size(); ++i)
    for (const double time : {0.9, 2.6}) {
      SCOPED_TRACE(i);
      const Vector3 point(3, -2, 5 + time);
      const FlowSample sample = flows[i](point, time);
      const Matrix3 gradient = gradientBy(flows[i], point, time);
      EXPECT_LT((sample.gradient - gradient).norm(), 1e-5 * (1 + gradient.norm()));
      const Vector3 change = changeAlong(flows[i], point, time);
      EXPECT_LT((sample.acceleration - change).norm(), 1e-5 * (1 + change.norm()));
    }
}

TEST(Flows, AreCalledWithoutAllocation) {
  const std::vector<FlowField> flows = allFlows();
  Vector3 sum = Vector3::Zero();
  const std::size_t before = allocationCount();
  for (const FlowField& flow : flows) sum += flow({1, 2, 3}, 4).velocity;
  EXPECT_EQ(allocationCount(), before);
  EXPECT_TRUE(sum.allFinite());
}

// Of gusts that blow everywhere at once each thread keeps the last sample.
TEST(Flows, KeepApartSeedsAndTimesThatFollowEachOther) {
  const FlowField one = gaussMarkovGusts({{1, 1, 1}, 1, 1}),
                  two = gaussMarkovGusts({{1, 1, 1}, 1, 2});
  const Vector3 here(0, 0, 0), first = one(here, 3).velocity, second = two(here, 3).velocity;
  EXPECT_NE(first, second);
  EXPECT_EQ(one(here, 3).velocity, first);
  EXPECT_NE(one(here, 4).velocity, first);
  EXPECT_EQ(gaussMarkovGusts({{1, 1, 1}, 1, 2})(here, 3).velocity, second);
}

TEST(Flows, AddNothingWhereOneIsEmpty) {
  const FlowField gust = discreteGust({{1, 0, 0}, 0, 1, 0});
  EXPECT_EQ((FlowField() + gust)({0, 0, 0}, 1).velocity, Vector3(1, 0, 0));
  EXPECT_EQ((gust + nullptr)({0, 0, 0}, 1).velocity, Vector3(1, 0, 0));
  EXPECT_FALSE(FlowField() + FlowField());
}

TEST(Turbulence, HasNoDivergence) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const FlowField eddies = turbulence(carriedTurbulence(seed));
    const Matrix3 gradient = eddies({1, 2, 3}, 4).gradient;
    EXPECT_LT(std::abs(gradient.trace()), 1e-14 * gradient.norm());
  }
}

// Longitudinal correlation of von Karman's spectrum, 2^(2/3) / Gamma(1/3) x^(1/3) K_1/3(x), x =
// k_e r; across the way f + r f'/2 = that - 2^(2/3) / Gamma(1/3) x^(4/3) K_2/3(x) / 2.
double karmanCorrelation(double x, bool is_along) {
  if (x == 0) return 1;
  const double factor = std::cbrt(4) / std::tgamma(1.0 / 3);
  const double along = factor * std::cbrt(x) * std::cyl_bessel_k(1.0 / 3, x);
  return is_along ? along
                  : along - factor / 2 * std::pow(x, 4.0 / 3) * std::cyl_bessel_k(2.0 / 3, x);
}

TEST(Turbulence, HasVonKarmansVarianceAndCorrelation) {
  constexpr double kCut = 0.0145;  // share of the energy beyond the smallest wavelength
  for (const double x : {0.0, 0.05, 0.2, 0.7, 2.0})
    for (const bool is_along : {true, false}) {
      SCOPED_TRACE(x);
      const Vector3 way = x / 0.7468343 * carriedTurbulence().length * Vector3::UnitX();
      const Vector3 axis = is_along ? Vector3::UnitX() : Vector3::UnitZ();
      GustMean product;
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const FlowField eddies = turbulence(carriedTurbulence(seed));
        for (const double time : {0.0, 517.0})
          product.add(axis.dot(eddies({0, 0, 0}, time).velocity) *
                      axis.dot(eddies(way, time).velocity));
      }
      const double variance = carriedTurbulence().intensity * carriedTurbulence().intensity;
      expectWithin3Sigma(product, variance * (karmanCorrelation(x, is_along) - kCut), variance);
    }
}

// Of each shell the four waves have the same energy in all directions: so has each field.
TEST(Turbulence, IsIsotropicInEachField) {
  Turbulence eddies;
  eddies.length = eddies.smallest = 1;  // few waves are long: the mean over a cube is soon found
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    eddies.seed = seed;
    const FlowField field = turbulence(eddies);
    Matrix3 mean = Matrix3::Zero();
    constexpr int kPoints = 40000;
    for (int i = 0; i < kPoints; ++i) {
      const Vector3 u = field({i * 7.31, i * 11.87, i * 5.03}, 0).velocity;
      mean += u * u.transpose() / kPoints;
    }
    EXPECT_LT((mean / mean.trace() - Matrix3::Identity() / 3).norm(), 0.02);
  }
}

TEST(Turbulence, IsCarriedAlong) {
  const Turbulence moving = carriedTurbulence();
  Turbulence frozen = moving;
  frozen.carried.setZero();
  const Vector3 point(1, 2, 3);
  EXPECT_LT((turbulence(moving)(point + 7 * moving.carried, 7).velocity -
             turbulence(frozen)(point, 3).velocity)
                .norm(),
            1e-12);
}

TEST(WindProfile, IsTheLogarithmAndThePower) {
  WindProfile wind;
  wind.velocity = {10, 0, 5};
  wind.ground = 2;
  wind.roughness = 0.1;
  EXPECT_NEAR(windProfile(wind)({0, 0, 3}, 0).velocity.x(), 5, 1e-14);
  EXPECT_EQ(windProfile(wind)({0, 0, 2.05}, 0).velocity.norm(), 0);
  EXPECT_EQ(windProfile(wind)({0, 0, 12}, 0).velocity.z(), 0) << "wind is horizontal";
  wind.roughness = 0;
  wind.exponent = 0.5;
  EXPECT_NEAR(windProfile(wind)({0, 0, 4.5}, 0).velocity.x(), 5, 1e-14);
  EXPECT_EQ(windProfile(wind)({0, 0, 2}, 0).velocity.norm(), 0);
}

TEST(CurrentProfile, IsLinearBetweenItsLevels) {
  const FlowField current = currentProfile({{1, {2, 0, 0}}, {3, {0, 0, 0}}}, 5);
  EXPECT_EQ(current({0, 0, 5.1}, 0).velocity.x(), 0) << "above the surface";
  EXPECT_EQ(current({0, 0, 4.5}, 0).velocity.x(), 2);
  EXPECT_NEAR(current({0, 0, 3.5}, 0).velocity.x(), 1.5, 1e-14);
  EXPECT_EQ(current({0, 0, -9}, 0).velocity.x(), 0);
}

TEST(DiscreteGust, RisesHoldsAndFalls) {
  const FlowField gust = discreteGust({{0, 0, 8}, 1, 2, 3});
  const double at[][2] = {{0.9, 0}, {2, 4}, {3, 8}, {6, 8}, {7, 4}, {8.1, 0}};
  for (const auto& [time, speed] : at)
    EXPECT_NEAR(gust({9, 9, 9}, time).velocity.z(), speed, 1e-14) << time;
  const FlowField lasting =
      discreteGust({{0, 0, 8}, 1, 2, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(lasting({0, 0, 0}, 1e9).velocity.z(), 8);
}

std::string flowError(const std::function<void()>& make) {
  return refusalOf<std::invalid_argument>(make);
}

TEST(Flows, SayWhatIsWrong) {
  WindProfile wind;
  wind.roughness = 20;
  EXPECT_EQ(flowError([&] { windProfile(wind); }),
            "wind profile: roughness [m] is 20; must be from 0 to below the height");
  EXPECT_EQ(flowError([] {
              currentProfile({{2, {0, 0, 0}}, {1, {0, 0, 0}}});
            }),
            "current profile: depth [m] of level 1 is 1; must be finite, and at least that of the "
            "level before and 0");
  EXPECT_EQ(flowError([] { currentProfile({}); }),
            "current profile: number of levels is 0; must be at least 1");
  EXPECT_EQ(flowError([] {
              discreteGust({{0, 0, 1}, 0, 0, 0});
            }),
            "discrete gust: rise [s] is 0; must be positive and finite");
  DrydenGusts gusts;
  gusts.height = 1;
  EXPECT_EQ(flowError([&] { drydenGusts(gusts); }),
            "Dryden gusts: height [m] is 1; must be at least 3.048 and finite");
  EXPECT_EQ(flowError([] {
              gaussMarkovGusts({{1, 1, 1}, 0});
            }),
            "Gauss-Markov gusts: time [s] is 0; must be positive and finite");
  Turbulence eddies;
  eddies.smallest = 200;
  EXPECT_EQ(flowError([&] { turbulence(eddies); }),
            "turbulence: smallest wavelength [m] is 200; must be from 0 to the length");
  EXPECT_EQ(flowError([] {
              layers({{1, 1000}, {0, 1000}});
            }),
            "height [m] of level 1 of the layers is 0; must be at least that of the level before");
  EXPECT_EQ(flowError([] { standardAtmosphere(1e5); }),
            "height in the standard atmosphere [m] is 100000; must be from -5000 to 86000");
}

}  // namespace
}  // namespace ambient::test
