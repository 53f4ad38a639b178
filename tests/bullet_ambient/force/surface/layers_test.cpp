#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/profiles.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Densities of table I of U.S. Standard Atmosphere 1976 at the bases of its layers (geopotential
// heights), as poliastro's documentation prints them; viscosities at 0 and 10 km, and the densities
// at 5 and 10 km, from memory.
TEST(StandardAtmosphere, IsThatOfItsTable) {
  constexpr double kEarth = 6356766;
  const double bases[][2] = {{0, 1.2250},        {11000, 3.6392e-1}, {20000, 8.8035e-2},
                             {32000, 1.3225e-2}, {47000, 1.4275e-3}, {51000, 8.6160e-4},
                             {71000, 6.4211e-5}};
  for (const auto& [height, density] : bases) {
    const double found = standardAtmosphere(kEarth * height / (kEarth - height)).density;
    EXPECT_NEAR(found, density, 1e-4 * density) << height;
  }
  EXPECT_NEAR(standardAtmosphere(5000).density, 0.73643, 1e-4 * 0.73643);
  EXPECT_NEAR(standardAtmosphere(10000).density, 0.41351, 1e-4 * 0.41351);
  EXPECT_NEAR(standardAtmosphere(0).viscosity, 1.7894e-5, 1e-4 * 1.7894e-5);
  EXPECT_NEAR(standardAtmosphere(10000).viscosity, 1.4577e-5, 1e-4 * 1.4577e-5);
}

TEST(AirLayers, KeepToTheStandard) {
  const auto air = airLayers(-200, 11000);
  for (double height = -150; height < 11000; height += 37) {
    const double density = standardAtmosphere(height).density;
    EXPECT_NEAR(air->density(height), density, 3e-5 * density);
  }
}

TEST(DensityLayers, AreLinearBetweenLevelsWithSteps) {
  const auto water = layers({{-10, 1030}, {-5, 1020}, {-5, 1000}, {0, 990}}, {0, 0, 3});
  EXPECT_EQ(water->density(-20), 1030);
  EXPECT_EQ(water->density(-7.5), 1025);
  EXPECT_EQ(water->density(-5), 1020);
  EXPECT_EQ(water->density(-2.5), 995);
  EXPECT_EQ(water->density(1), 990);
}

FluidBody lightBall(double radius) {
  FluidBody ball;
  ball.sphere_radius = radius;
  ball.volume = 4 * kPi / 3 * radius * radius * radius;
  ball.centre_of_volume = {0.3, -0.2, 0.1};
  return ball;
}

// rho(c) V, and the moment of a density that grows by rho' along up: rho(c) V c + rho' V R^2/5 up.
TEST(LayeredBuoyancy, IsExactForABallInALinearDensity) {
  constexpr double kRadius = 0.5, kReference = 1000, kSlope = -8;
  const FluidBody ball = lightBall(kRadius);
  const Vector3 up = Vector3(1, 2, -2) / 3;
  const auto water = layers({{-50, kReference - kSlope * 50}, {50, kReference + kSlope * 50}}, up);
  const ExcessFluid found = findExcessFluid({ball, nullptr, up, 3.7}, *water, kReference);
  const double excess = kSlope * (3.7 + up.dot(ball.centre_of_volume)) * ball.volume;
  const Vector3 moment =
      excess * ball.centre_of_volume + kSlope * ball.volume * kRadius * kRadius / 5 * up;
  EXPECT_NEAR(found.mass, excess, 1e-12 * std::abs(excess));
  EXPECT_LT((found.moment - moment).norm(), 1e-12 * moment.norm());
}

// Density 1000 below the ball's centre and 1000 + s z above: int of z over half a ball is
// pi R^4 / 4.
TEST(LayeredBuoyancy, IsExactForABallAtAKink) {
  FluidBody ball = lightBall(0.5);
  ball.centre_of_volume.setZero();
  const auto water = layers({{0, 1000}, {1, 990}});
  const double found = findExcessFluid({ball, nullptr, {0, 0, 1}, 0}, *water, 1000).mass;
  EXPECT_NEAR(found, -10 * kPi / 4 * std::pow(0.5, 4), 1e-12);
}

// The surface at 0.1 over the centre, a step 0.2 below it: of an upright box, by hand.
TEST(LayeredBuoyancy, TakesStepsAndTheSurface) {
  const FluidBody box = boxBody({2, 1, 1}, 2);
  const PackedHull hull(box);
  const auto water = layers({{4.8, 1030}, {4.8, 1005}});
  const ExcessFluid found = findExcessFluid({box, &hull, {0, 0, 1}, 5, 5.1}, *water, 1000);
  EXPECT_NEAR(found.mass, 2 * (0.3 * 30 + 0.3 * 5), 1e-12);
  EXPECT_NEAR(found.moment.z(), 2 * (0.3 * 30 * -0.35 + 0.3 * 5 * -0.05), 1e-12);
}

// Of tilted boxes, in a density that is linear over them, and by four nodes over the height where
// their second moments are not known, or a surface that they do not reach is given.
TEST(LayeredBuoyancy, HoldsForTiltedBoxes) {
  const Vector3 size(2, 1, 0.5);
  FluidBody known = boxBody(size, 2);
  known.uniform_mass.inertia = (Vector3(1 + 0.25, 0.25 + 4, 4 + 1) / 12).asDiagonal();
  FluidBody unknown = known;
  unknown.uniform_mass = {};
  const PackedHull hull(known);
  Arbitrary arbitrary(3);
  for (int i = 0; i < 100; ++i) {
    const Vector3 up = arbitrary.vector().normalized();
    const auto water = layers({{-5, 1050}, {5, 950}}, up);
    const double met = 10 * up.cwiseAbs().dot(size);  // difference of the densities that it meets
    const Vector3 moment = -10.0 / 12 * size.cwiseAbs2().cwiseProduct(up);
    for (const FluidBody* box : {&known, &unknown}) {
      const double error = box == &known ? 1e-12 : 1;
      const ExcessFluid found = findExcessFluid({*box, &hull, up, 1}, *water, 1000);
      EXPECT_NEAR(found.mass, -10, error * 1e-3 * met);
      EXPECT_LT((found.moment - moment).norm(), error * 3e-3 * met * size.norm());
    }
  }
}

}  // namespace
}  // namespace ambient::test
