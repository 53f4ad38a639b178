#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/surface/flotation.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

const SurfacePlane kPlane{{0, 0, 1}, 0, 1, 1};

/// The flotation of a body of unit inertia whose fluid has an added mass per unit density, times a
/// factor.
Flotation flotationOf(const WetVolume& wet, const SurfacePlane& plane, double added_mass = 0,
                      double factor = 1) {
  SurfaceModel model;
  model.above.inertia = Matrix6::Identity();
  model.excess_density = plane.density;
  model.added_density = factor * plane.density;
  Flotation flotation;
  flotation.plane = plane;
  flotation.immersion_F.wet = wet;
  Matrix6 inertia = Matrix6::Identity();
  inertia.diagonal().tail<3>().array() += model.added_density * added_mass;
  flotation.inertia = SymmetricMatrix(inertia);
  const SurfaceModel* const models = &model;
  Flotation* const flotations = &flotation;
  completeFlotations(&models, &flotations, 1);
  return flotation;
}

/// Lets waves meet modes, and act for no time.
void projectOnModes(const FloatingModes& modes, const Matrix3& to_world, WaveMemory& waves) {
  const Vector6 rest = Vector6::Zero();
  const SymmetricMatrix inverse{Matrix6(Matrix6::Identity())};
  EXPECT_EQ(exchangeWaves(modes, to_world, inverse, 0, rest, waves), rest);
}

/// A hemisphere of radius 1 in water of density 1 and gravity 1.
FloatingModes hemisphere() {
  return flotationOf(computeWetSphere(1, {0, 0, 0}, kPlane), kPlane, kPi / 3).modes;
}

/// Force over velocity of a mode: 0, heave; 1 and 2, tilts; B + i omega (A - A(inf)).
std::complex<double> impedance(const FloatingModes& modes, int mode, double frequency) {
  const std::complex<double> s(0, frequency);
  const double rate = modes.rate[mode];
  return modes.strength[mode] * s / (s * s + modes.loss[mode] * s + rate * rate);
}

TEST(BodyWaves, DampTheHeaveOfAHemisphereAsHulmeSays) {
  // Hulme 1982: A33 and B33 in units of rho R^3, and of rho R^3 sqrt(g/R), at k R; A33(inf) is
  // pi/3. The model's two states reach a tenth of the total inertia near the natural frequency, k R
  // = 1.05.
  const FloatingModes modes = hemisphere();
  const double total = 2 * kPi / 3 + kPi / 3;
  const struct {
    double frequency, added, damping;
  } cases[] = {{0.7511, 1.1606, 0.5227}, {1.0623, 0.8622, 0.4961}, {1.4052, 0.8127, 0.3102}};
  for (const auto& c : cases) {
    const std::complex<double> z = impedance(modes, 0, c.frequency);
    EXPECT_NEAR(z.real(), c.damping, 0.04 * total * c.frequency) << c.frequency;
    EXPECT_NEAR(z.imag() / c.frequency, c.added - kPi / 3, 0.04 * total) << c.frequency;
  }
}

/// Wave modes of a box in water of density 1 and gravity 1.
FloatingModes boxModes(double length, double breadth, double draught, double added_mass) {
  const double area = length * breadth, volume = area * draught;
  WetVolume wet{volume, {0, 0, -volume * draught / 2}, 0, {area, {0, 0, 0}, Matrix3::Zero()}};
  wet.waterplane.spread.diagonal() << area * length * length / 12, area * breadth * breadth / 12, 0;
  return flotationOf(wet, kPlane, added_mass).modes;
}

TEST(BodyWaves, DoNotDependOnTheFactorOnTheAddedMass) {
  const FloatingModes modes = hemisphere();
  const WetVolume wet = computeWetSphere(1, {0, 0, 0}, kPlane);
  for (const double factor : {0.3, 3.0}) {
    const FloatingModes other = flotationOf(wet, kPlane, kPi / 3, factor).modes;
    EXPECT_NEAR(other.strength[0], modes.strength[0], 1e-13 * modes.strength[0]);
    EXPECT_NEAR(other.rate[0], modes.rate[0], 1e-13 * modes.rate[0]);
  }
}

TEST(BodyWaves, OfTheHeaveOfBoxesHaveTheImpedanceOfTheFit) {
  // Impedance over frequency and total inertia M, which has Capytaine's A33(inf). Linear
  // theory: 0.318, +0.09 and 0.245, -0.07 for the barge, 0.647, +0.47 and 0.629, +0.19 for the
  // raft.
  const struct {
    double length, breadth, draught, added_mass, wave_number, damping, added;
  } cases[] = {{2, 1, 0.25, 0.7878, 1, 0.340, 0.09},
               {2, 1, 0.25, 0.7878, 2, 0.248, -0.05},
               {4, 4, 0.1, 16.0031, 1, 0.572, 0.51},
               {4, 4, 0.1, 16.0031, 2, 0.634, 0.24}};
  for (const auto& c : cases) {
    const double area = c.length * c.breadth, total = area * c.draught + c.added_mass;
    const double frequency = std::sqrt(c.wave_number / std::sqrt(area));
    const FloatingModes modes = boxModes(c.length, c.breadth, c.draught, c.added_mass);
    const std::complex<double> z = impedance(modes, 0, frequency) / (frequency * total);
    EXPECT_NEAR(z.real(), c.damping, 0.006) << c.length << " " << c.wave_number;
    EXPECT_NEAR(z.imag(), c.added, 0.006) << c.length << " " << c.wave_number;
  }
}

TEST(BodyWaves, HaveTheCoefficientsOfBoxes) {
  // A33, B33, A44, B44 at frequency w, and A(inf), by Capytaine 3.0: direct method, deep water, rho
  // = g = 1, about the centre of the waterplane. Two states reach 0.07 of the total inertia up to
  // twice the natural frequency. Roll's dipole is the one of a freely swaying body: only its
  // smallness is checked.
  const struct {
    double length, breadth, draught, heave_inf, roll_inf, w, a33, b33, b44;
  } cases[] = {{2, 1, 0.25, 0.7837, 0.0268, 0.5946, 1.0946, 0.2195, 5.12e-5},
               {2, 1, 0.25, 0.7837, 0.0268, 0.8409, 0.8965, 0.3472, 3.79e-4},
               {2, 1, 0.25, 0.7837, 0.0268, 1.1892, 0.6969, 0.3782, 1.18e-3},
               {2, 1, 0.25, 0.7837, 0.0268, 1.5732, 0.6272, 0.2505, 4.02e-4},
               {1, 1, 0.5, 0.3213, 0.0201, 0.7071, 0.3556, 0.0683, 2.26e-4},
               {1, 1, 0.5, 0.3213, 0.0201, 1.0000, 0.3017, 0.0786, 2.35e-3},
               {1, 1, 0.5, 0.3213, 0.0201, 1.4142, 0.2836, 0.0417, 0.0099}};
  for (const auto& c : cases) {
    const double mass = c.length * c.breadth * c.draught, total = mass + c.heave_inf;
    // Added mass of (60), a factor 1.13 below the exact one.
    const FloatingModes modes = boxModes(c.length, c.breadth, c.draught, c.heave_inf);
    const std::complex<double> heave = impedance(modes, 0, c.w);
    EXPECT_NEAR(heave.real(), c.b33, 0.07 * total * c.w) << c.length << " " << c.w;
    EXPECT_NEAR(heave.imag() / c.w, c.a33 - c.heave_inf, 0.07 * total) << c.length << " " << c.w;
    const double gyration = 0.4 * c.breadth;
    const double roll = mass * gyration * gyration + c.roll_inf;
    const bool is_first = std::abs(modes.tilt[0].x) > 0.5;
    EXPECT_NEAR(impedance(modes, is_first ? 1 : 2, c.w).real(), c.b44, 0.1 * roll * c.w)
        << c.length << " " << c.w;
  }
}

TEST(FloatingModes, OfABoxAreThoseOfItsWaterplane) {
  // 2 x 1, draught 0.25, about a centre of mass in the waterline: V GM = I - V T/2.
  const SurfacePlane plane{{0, 0, 1}, 0, 2, 3};
  WetVolume wet{0.5, {0, 0, -0.5 * 0.125}, 0, {2, {0, 0, 0}, Matrix3::Zero()}};
  wet.waterplane.spread.diagonal() << 2 * 4 / 12.0, 2 / 12.0, 0;
  const FloatingModes modes = flotationOf(wet, plane).modes;
  EXPECT_NEAR(modes.stiffness[0], 6 * 2, 1e-14);
  for (int i = 0; i < 2; ++i) {
    const bool is_roll = std::abs(modes.tilt[i].x) > 0.5;
    EXPECT_NEAR(std::abs(is_roll ? modes.tilt[i].x : modes.tilt[i].y), 1, 1e-14);
    EXPECT_NEAR(modes.stiffness[i + 1], 6 * ((is_roll ? 1 / 6.0 : 2 / 3.0) - 0.0625), 1e-14);
  }
}

TEST(FloatingModes, HavePrincipalAxesWhateverTheAttitude) {
  test::Arbitrary arbitrary(2);
  for (int i = 0; i < 50; ++i) {
    const Matrix3 R = arbitrary.rotation();
    const SurfacePlane plane{R.col(2), 0, 1, 1};
    WetVolume wet{0.5, {0, 0, 0}, 0, {2, {0, 0, 0}, Matrix3::Zero()}};
    wet.waterplane.spread = R * Vector3(0.7, 0.2, 0).asDiagonal() * R.transpose();
    const FloatingModes modes = flotationOf(wet, plane).modes;
    const double a = modes.second_moment[0], b = modes.second_moment[1];
    EXPECT_NEAR(std::max(a, b), 0.7, 1e-13);
    EXPECT_NEAR(std::min(a, b), 0.2, 1e-13);
  }
}

TEST(BodyWaves, BallThatTurnsMakesNone) {
  const FloatingModes modes = hemisphere();
  EXPECT_GT(modes.strength[0], 0);
  EXPECT_LT(modes.strength[1], 1e-20);
  EXPECT_LT(modes.strength[2], 1e-20);
}

TEST(BodyWaves, AreNoneWithoutAWaterplane) {
  const SurfacePlane above{{0, 0, 1}, -2, 1, 1};
  const WetVolume dry = computeWetSphere(1, {0, 0, 0}, above);
  const FloatingModes modes = flotationOf(dry, above).modes;
  WaveMemory waves;
  waves.heave.first = 1;
  waves.heave_energy = 1;
  projectOnModes(modes, Matrix3::Identity(), waves);
  EXPECT_EQ(waves.energy(), 0);
  EXPECT_EQ(waves.heave.first, 0);
}

FloatingModes arbitraryModes(test::Arbitrary& arbitrary) {
  const auto between = [&](double least, double most) { return arbitrary.between(least, most); };
  const auto vector = [&] {
    return VectorsOf<double>{between(-1, 1), between(-1, 1), between(-1, 1)};
  };
  FloatingModes modes{{vector(), vector()}, {{1, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {}};
  for (int i = 0; i < 3; ++i) {
    modes.strength[i] = between(0, 10);
    modes.loss[i] = between(0, 3);
    modes.rate[i] = between(0.01, 3);
  }
  return modes;
}

TEST(BodyWaves, NeverAddEnergyWhateverTheStep) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 300; ++i) {
    const Matrix6 K = arbitrary.positiveDefinite();
    const SymmetricMatrix inverse{Matrix6(test::inverse(K))};
    Vector6 x = arbitrary.twist().vector();
    const Matrix3 turn = arbitrary.rotation();
    WaveMemory waves;
    double energy = 0.5 * x.dot(K * x);
    for (int n = 0; n < 20; ++n) {
      const FloatingModes modes = arbitraryModes(arbitrary);
      x = exchangeWaves(modes, turn, inverse, std::pow(10, arbitrary.between(-2, 1)), x, waves);
      const double now = 0.5 * x.dot(K * x) + waves.energy();
      ASSERT_LE(now, energy * (1 + 1e-12)) << i;
      energy = now;
    }
  }
}

TEST(BodyWaves, AreAsAnOscillatorBehindAVelocity) {
  // A heavy body with a constant velocity u.
  FloatingModes modes{};
  modes.heave.linear.z = modes.tilt[0].x = modes.tilt[1].y = 1;
  modes.strength[0] = modes.rate[0] = 1;
  modes.loss[0] = 1.5;
  const SymmetricMatrix inverse{Matrix6(1e-12 * Matrix6::Identity())};
  Vector6 x = Vector6::Zero();
  x[5] = 2;
  WaveMemory waves;
  // Sudden u in s'' + a s' + b^2 s = u': s_1 = u/p exp(-at/2) sin pt, p^2 = b^2 - a^2/4.
  const double p = std::sqrt(1 - 0.5625), time = 1;
  for (int i = 0; i < 1000; ++i)
    x = exchangeWaves(modes, Matrix3::Identity(), inverse, time / 1000, x, waves);
  EXPECT_NEAR(waves.heave.first, 2 / p * std::exp(-0.75 * time) * std::sin(p * time), 1e-5);
}

TEST(BodyWaves, OfTheTiltStayInTheWorld) {
  // A quarter turn about the vertical exchanges the body's axes, but not the waves.
  const FloatingModes modes{{},        {{1, 0, 0}, {0, 1, 0}}, {},       {},
                            {0, 2, 2}, {0, 0.1, 0.1},          {1, 1, 1}};
  WaveMemory waves;
  waves.tilt_W[0] = {0.3, 0.4, 0};
  waves.tilt_W[1] = {-0.1, 0.2, 0};
  waves.tilt_energy = 100;
  const Matrix3 quarter{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  projectOnModes(modes, Matrix3::Identity(), waves);
  const double energy = waves.tilt_energy;
  projectOnModes(modes, quarter, waves);
  EXPECT_NEAR(waves.tilt_W[0].x, 0.3, 1e-15);
  EXPECT_NEAR(waves.tilt_W[0].y, 0.4, 1e-15);
  EXPECT_NEAR(waves.tilt_W[0].z, 0, 1e-15);
  EXPECT_NEAR(waves.tilt_energy, energy, 1e-15);
  EXPECT_NEAR(energy, 0.5 * 2 * (0.25 + 0.05), 1e-15);
}

TEST(BodyWaves, LoseEnergyWhereTheirStrengthGrows) {
  FloatingModes modes = hemisphere();
  WaveMemory waves;
  waves.heave.first = 0.1;
  waves.heave_energy = 1e-4;
  projectOnModes(modes, Matrix3::Identity(), waves);
  EXPECT_NEAR(waves.heave_energy, 1e-4, 1e-18);
  EXPECT_NEAR(0.5 * modes.strength[0] * waves.heave.first * waves.heave.first, 1e-4, 1e-18);
}

}  // namespace
}  // namespace ambient
