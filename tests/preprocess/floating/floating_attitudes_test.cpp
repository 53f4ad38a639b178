#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/floating/floating_body.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/holds/hold_search.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/mesh/mass_properties.h"
#include "tests/preprocess/mesh/vessel_meshes.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

constexpr double kWater = 1000, kFloatGravity = 9.81;

// A homogeneous box of given specific gravity, without added mass.
FloatingBody boxAfloat(const Vector3& size, double specific_gravity) {
  FloatingBody body;
  body.shape = std::make_shared<FluidBody>(boxBody(size));
  body.density = kWater;
  body.gravity = kFloatGravity;
  body.mass = specific_gravity * kWater * size.prod();
  body.inertia = boxMoments(size, body.mass).asDiagonal();
  return body;
}

Vector3 sortedSizes(const Vector3& v) {
  Vector3 sizes = v.cwiseAbs();
  std::sort(sizes.data(), sizes.data() + 3);
  return sizes;
}

// Attitude that most descents reach.
FloatingAttitude mainAttitude(const FloatingBody& body) {
  return findFloatingAttitudes(body).at(0);
}

// Neutral attitudes between flat and corner up: a cube turns about the vertical without moment.
TEST(FloatingAttitudes, ATiltedCubeIsNeutral) {
  const FloatingAttitude tilted = mainAttitude(boxAfloat({1, 1, 1}, 0.225));
  EXPECT_NEAR(tilted.metacentres[0].height, 0, 1e-9);
  EXPECT_GT(tilted.metacentres[1].height, 0.01);
}

// 6 s (1 - s) < 1: the metacentre of a flat cube is above its centre of mass.
TEST(FloatingAttitudes, ACubeIsFlatTiltedOrOnACorner) {
  const double kFlatBelow = 0.5 - std::sqrt(1.0 / 12);  // 0.2113
  for (const double s : {0.05, 0.2, kFlatBelow - 0.002, 1 - kFlatBelow + 0.002, 0.9}) {
    const FloatingAttitude flat = mainAttitude(boxAfloat({1, 1, 1}, s));
    EXPECT_NEAR(sortedSizes(flat.up)[2], 1, 1e-6) << s;
    EXPECT_NEAR(flat.draught, s, 1e-6) << s;  // slight tilt has little effect on the draught
    EXPECT_EQ(flat.alike, 6) << s;
    EXPECT_GT(flat.share, 0.75) << s;  // near the limits also corner up
    // GM = B^2 / 12 T - (B - T) / 2
    for (const Metacentre& metacentre : flat.metacentres)
      EXPECT_NEAR(metacentre.height, 1 / (12 * s) - (1 - s) / 2, 1e-6) << s;
  }
  for (const double s : {kFlatBelow + 0.002, 0.225, 0.775}) {
    const Vector3 tilted = sortedSizes(mainAttitude(boxAfloat({1, 1, 1}, s)).up);
    EXPECT_LT(tilted[2], 0.9999) << s;
    EXPECT_GT(tilted[2], 0.8) << s;
  }
  for (const double s : {0.3, 0.5, 0.7}) {
    const FloatingAttitude corner = mainAttitude(boxAfloat({1, 1, 1}, s));
    EXPECT_LT((sortedSizes(corner.up) - Vector3::Constant(std::sqrt(1.0 / 3))).norm(), 1e-5) << s;
    EXPECT_EQ(corner.alike, 8) << s;
  }
}

// A long square bar floats on an edge for 9/32 < s < 23/32 (Reid 1963).
TEST(FloatingAttitudes, ALongBarFloatsOnItsEdge) {
  for (const double s : {9.0 / 32 + 0.003, 0.5, 23.0 / 32 - 0.003}) {
    const Vector3 up = sortedSizes(mainAttitude(boxAfloat({9, 1, 1}, s)).up);
    EXPECT_NEAR(up[0], 0, 1e-6) << s;
    EXPECT_NEAR(up[1], std::sqrt(0.5), 1e-4) << s;
  }
  for (const double s : {9.0 / 32 - 0.003, 23.0 / 32 + 0.003})
    EXPECT_LT(sortedSizes(mainAttitude(boxAfloat({9, 1, 1}, s)).up)[1], 0.7) << s;
}

const FloatingAttitude* withUp(const std::vector<FloatingAttitude>& all, const Vector3& up) {
  for (const FloatingAttitude& each : all)
    if (each.up.cwiseAbs().dot(up) > 1 - 1e-6) return &each;
  return nullptr;
}

// Without added mass: heave sqrt(m / rho g A), turns sqrt(I / m g GM).
TEST(FloatingAttitudes, ABargeHasTheMetacentresAndPeriodsOfItsBox) {
  const Vector3 size(4, 2, 1);
  const double s = 0.4, draught = 0.4;
  const FloatingBody body = boxAfloat(size, s);
  const auto all = findFloatingAttitudes(body);
  const FloatingAttitude* upright = withUp(all, Vector3::UnitZ());
  ASSERT_NE(upright, nullptr);
  EXPECT_NEAR(upright->draught, draught, 1e-9);
  EXPECT_NEAR(upright->height_of_mass, 0.5 - draught, 1e-9);
  EXPECT_NEAR(upright->wet.waterplane.area, 8, 1e-9);
  const double below = 0.5 - draught / 2;
  const double roll = 4 / (12 * draught) - below, pitch = 16 / (12 * draught) - below;
  EXPECT_NEAR(upright->metacentres[0].height, roll, 1e-6 * roll);
  EXPECT_NEAR(std::abs(upright->metacentres[0].axis.x()), 1, 1e-6);
  EXPECT_NEAR(upright->metacentres[1].height, pitch, 1e-6 * pitch);
  EXPECT_NEAR(std::abs(upright->metacentres[1].axis.y()), 1, 1e-6);
  const auto period = [&](double inertia, double stiffness) {
    return 2 * kPi * std::sqrt(inertia / stiffness);
  };
  const double weight = body.mass * kFloatGravity;
  const double heave = period(body.mass, kWater * kFloatGravity * 8);
  int heaves = 0;
  for (const SmallOscillation& mode : upright->modes) {
    heaves += mode.is_heave;
    if (mode.is_heave) {
      EXPECT_NEAR(mode.period, heave, 1e-6);
    }
    if (std::abs(mode.turn.x()) > 0.9) {
      EXPECT_NEAR(mode.period, period(body.inertia(0, 0), weight * roll), 1e-6);
    }
    if (std::abs(mode.turn.y()) > 0.9) {
      EXPECT_NEAR(mode.period, period(body.inertia(1, 1), weight * pitch), 1e-6);
    }
  }
  EXPECT_EQ(heaves, 1);
}

TEST(FloatingAttitudes, AddedMassMakesPeriodsLonger) {
  FloatingBody body = boxAfloat({4, 2, 1}, 0.4);
  const double dry = withUp(findFloatingAttitudes(body), Vector3::UnitZ())->modes[0].period;
  FluidBody heavy = *body.shape;
  // Body without parts: added mass times the wet share.
  heavy.added_mass = 3 * heavy.volume * Matrix6::Identity();
  body.shape = std::make_shared<FluidBody>(heavy);
  const auto all = findFloatingAttitudes(body);
  for (const SmallOscillation& mode : withUp(all, Vector3::UnitZ())->modes)
    if (mode.is_heave) {
      EXPECT_NEAR(mode.period, 2 * kPi * std::sqrt(4 * 0.4 / kFloatGravity), 1e-6);
    }
  EXPECT_GT(withUp(all, Vector3::UnitZ())->modes[0].period, dry);
}

// Mass near the bottom: a single attitude for any shape.
TEST(FloatingAttitudes, ALowCentreOfMassSettlesIt) {
  FloatingBody body = boxAfloat({1, 1, 1}, 0.5);
  body.centre_of_mass = {0, 0, -0.45};
  const auto all = findFloatingAttitudes(body);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].alike, 1);
  EXPECT_NEAR(all[0].up.z(), 1, 1e-9);
  EXPECT_NEAR(all[0].metacentres[0].height, 1 / (12 * 0.5) - (-0.45 + 0.25), 1e-9);
}

TEST(FloatingAttitudes, DoNotDependOnSizeAndFrame) {
  FloatingBody small = boxAfloat({0.04, 0.02, 0.01}, 0.4);
  const auto large = findFloatingAttitudes(boxAfloat({400, 200, 100}, 0.4));
  const auto all = findFloatingAttitudes(small);
  ASSERT_EQ(all.size(), large.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(all[i].draught, 1e-4 * large[i].draught, 1e-10 * large[i].draught);
    EXPECT_NEAR(all[i].modes[0].period, 1e-2 * large[i].modes[0].period, 1e-6);
  }
  FluidBody moved = *small.shape;
  for (std::size_t i = 0; i < moved.surface.vertices.size(); i += 3) moved.surface.vertices[i] += 3;
  moved.centre_of_volume.x() = 3;
  small.centre_of_mass.x() = 3;
  small.shape = std::make_shared<FluidBody>(moved);
  EXPECT_NEAR(findFloatingAttitudes(small)[0].draught, all[0].draught, 1e-9);
}

TEST(FloatingAttitudes, WhatIsTooHeavyHasNone) {
  EXPECT_TRUE(findFloatingAttitudes(boxAfloat({1, 1, 1}, 1.0)).empty());
  EXPECT_EQ(findFloatingAttitudes(boxAfloat({1, 1, 1}, 0.999)).at(0).alike, 6);
}

TEST(FloatingAttitudes, SayWhatIsWrong) {
  const auto complaint = [](const FloatingBody& body) {
    return refusalOf<std::invalid_argument>([&] { findFloatingAttitudes(body); });
  };
  FloatingBody body = boxAfloat({1, 1, 1}, 0.5);
  body.mass = 0;
  EXPECT_EQ(complaint(body), "fluid body 'hull': mass [kg] is 0, must be positive and finite");
  body.mass = 1e-7 * body.density;
  EXPECT_NE(complaint(body).find("must be at least a millionth of that of its volume of water"),
            std::string::npos);
  body = boxAfloat({1, 1, 1}, 0.5);
  body.centre_of_mass = {0, 0, -1e7};
  EXPECT_NE(complaint(body).find("must be at most a million times its size"), std::string::npos);
  body = boxAfloat({1, 1, 1}, 0.5);
  auto sheet = std::make_shared<FluidBody>(*body.shape);
  sheet->volume = 0;
  body.shape = sheet;
  EXPECT_EQ(complaint(body), "fluid body 'hull': volume [m^3] is 0, must be positive and finite");
}

constexpr double kDensityAtSea = 1025, kGravityAtSea = 9.81;

// Energy of water and weight [J] after a displacement by a twist of unit time about `point`.
double energyAfter(const Vector6& twist, const PackedHull& hull, const SurfacePlane& plane,
                   const PointMass& weight, const Vector3& point) {
  const Vector3 turn = twist.head<3>();
  const double angle = turn.norm();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (angle > 0) R = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  const Vector3 moved = point + twist.tail<3>() - R * point;
  const SurfacePlane seen = seenFrom(plane, Matrix3(R), moved);
  return hydrostaticEnergy(computeWetVolume(hull, seen), seen) -
         weight.mass * kGravityAtSea * seen.depth(weight.centre);
}

// Second differences of the energy; of six motions, so that the error is of the order of step^2.
Matrix6 secondDifferences(const PackedHull& hull, const SurfacePlane& plane,
                          const PointMass& weight, const Vector3& point) {
  constexpr double kStep = 1e-4;
  const auto energy = [&](int i, int j, double a, double b) {
    return energyAfter(kStep * (a * Vector6::Unit(i) + b * Vector6::Unit(j)), hull, plane, weight,
                       point);
  };
  Matrix6 K;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      K(i, j) =
          (energy(i, j, 1, 1) - energy(i, j, 1, -1) - energy(i, j, -1, 1) + energy(i, j, -1, -1)) /
          (4 * kStep * kStep);
  return K;
}

// A tilted box, its weight anywhere and not that of the water, about any point.
TEST(RestoringStiffness, IsTheSecondDerivativeOfTheEnergy) {
  const PackedHull hull(boxBody({2, 1, 0.6}, 4));
  const SurfacePlane plane{Vector3(0.2, -0.1, 1).normalized(), 0.07, kDensityAtSea, kGravityAtSea};
  const PointMass weight{700, {0.1, -0.05, -0.08}};
  const WetVolume wet = computeWetVolume(hull, plane);
  for (const Vector3& point : {Vector3(0, 0, 0), Vector3(0.4, -0.3, 0.5)}) {
    const Matrix6 K = restoringStiffness(wet, plane, weight, point);
    const Matrix6 differences = secondDifferences(hull, plane, weight, point);
    EXPECT_LT((K - differences).cwiseAbs().maxCoeff(), 1e-6 * K.cwiseAbs().maxCoeff()) << K;
  }
}

// Closed forms of naval architecture for a barge of 2 x 1 x 0.5 m with walls of 0.02 m and 200 kg
// in water of 1000 kg/m^3: wall-sided, with a free surface inside.

constexpr double kLength = 2, kWidth = 1, kWall = 0.02, kMass = 200, kDensity = 1000;
constexpr double kDegree = kPi / 180;

/// The barge without a flow: hydrostatics need its surface and holds alone.
FloatingBody afloat(const Barge& barge, double centre_of_mass) {
  const Vessel vessel = findHolds(makeBarge(barge), {}, "barge");
  auto shape = std::make_shared<FluidBody>();
  shape->name = "barge";
  shape->surface = surfaceOf(vessel.closed);
  shape->form.hull = shape->surface.triangles;
  shape->volume = tetrahedraVolume(vessel.closed, Vector3::Zero());
  shape->area = areaOf(vessel.closed);
  shape->holds = vessel.holds;
  FloatingBody body;
  body.shape = shape;
  body.mass = kMass;
  body.centre_of_mass = {0, 0, centre_of_mass};
  body.inertia = Matrix3::Identity();
  body.density = kDensity;
  return body;
}

/// Tilt from which it no longer moves, begun from a small one about an axis [rad].
double tiltOf(const FloatingBody& body, const Vector3& axis) {
  const PackedHull hull(*body.shape);
  const Vector3 begun = Eigen::AngleAxisd(0.02, Eigen::Vector3d(axis)) * Eigen::Vector3d::UnitZ();
  const Vector3 up = settle(body, hull, begun).plane.normal;
  return std::atan2(std::hypot(up.x(), up.y()), up.z());
}

/// GM of rolling.
double rollingGM(const FloatingBody& body) {
  const FloatingPose pose = floatAt(body, PackedHull(*body.shape), Vector3::UnitZ());
  return pose.stiffness(1, 1) / (body.mass * body.gravity) * kMass /
         (kMass + kDensity * (pose.outside.volume - pose.wet.volume));
}

TEST(VesselStatics, DryBargeFloatsOnItsOutside) {
  const FloatingBody body = afloat({}, 0.2);
  const FloatingPose pose = floatAt(body, PackedHull(*body.shape), Vector3::UnitZ());
  EXPECT_NEAR(pose.plane.height, kMass / (kDensity * kLength * kWidth), 1e-12);
}

// With water V in the hold of length l and breadth b: depth in it d = V / (l b), draught
// T = (m / rho + V) / (L B), and with the mass of all
// GM = (m (T/2 - KG) + rho V (T/2 - kg)) / (m + rho V) + (L B^3 - l b^3) / 12 / (m / rho + V).
TEST(VesselStatics, FreeSurfaceTakesItsSecondMomentOffGM) {
  constexpr double l = 1.96, b = 0.96;
  // Of even walls: floor and sides.
  constexpr double kFloor = kLength * kWidth * kWall, kSides = (kLength * kWidth - l * b) * 0.48;
  constexpr double kKG = (kFloor * kWall / 2 + kSides * 0.26) / (kFloor + kSides);
  const double expected[] = {0.726605, 0.010945, 0.028856, 0.046797, 0.053939};
  int i = 0;
  for (const double V : {0.0, 0.02, 0.1, 0.3, 0.6}) {
    FloatingBody body = afloat({}, kKG);
    setWater(body, {V});
    const double all = kMass / kDensity + V, T = all / (kLength * kWidth);
    const double kg = kWall + V / (l * b) / 2;
    const double inner = V > 0 ? l * b * b * b / 12 : 0;
    const double GM = T / 2 - (kMass / kDensity * kKG + V * kg) / all +
                      (kLength * kWidth * kWidth * kWidth / 12 - inner) / all;
    EXPECT_NEAR(rollingGM(body), GM, 1e-9) << V;
    EXPECT_NEAR(GM, expected[i++], 1e-6) << V;
    const FloatingPose pose = floatAt(body, PackedHull(*body.shape), Vector3::UnitZ());
    EXPECT_NEAR(pose.plane.height, T, 1e-12) << V;
  }
}

// Wall-sided outside and inside: tan^2 of the angle of loll is -2 GM / (BM_o - BM_i).
TEST(VesselStatics, LollsWhereGMIsNegative) {
  constexpr double kVolume = 0.2;
  for (const double KG : {0.2385, 0.24}) {
    FloatingBody body = afloat({}, KG);
    setWater(body, {kVolume});
    const double all = kMass / kDensity + kVolume;
    const double BM = (kLength - 1.96 * 0.96 * 0.96 * 0.96) / 12 / all;
    const double tilt = std::atan(std::sqrt(-2 * rollingGM(body) / BM));
    EXPECT_NEAR(tilt, (KG < 0.239 ? 7.0501 : 11.6314) * kDegree, 1e-6);
    EXPECT_NEAR(tiltOf(body, Vector3::UnitX()), tilt, 1e-6);
  }
}

TEST(VesselStatics, TrimsToTheHoldThatHasWater) {
  Barge barge;
  barge.bulkheads = {0.0};
  const double trims[] = {0.9883, 2.4598};
  int i = 0;
  for (const double V : {0.02, 0.05}) {
    FloatingBody body = afloat(barge, 0.15673);
    setWater(body, {V});
    EXPECT_NEAR(tiltOf(body, Vector3::UnitY()) / kDegree, trims[i++], 1e-4);
  }
}

// Lost buoyancy: a hold open to the sea floats as if its waterplane were cut out,
// (m / rho - a t) / (A - a) with its floor at t.
TEST(VesselStatics, HoldAtTheLevelOfTheSeaIsLostBuoyancy) {
  Barge barge;
  barge.bulkheads = {-0.4, 0.4};
  FloatingBody body = afloat(barge, 0.15673);
  ASSERT_EQ(body.shape->holds.size(), 3u);
  const double a = (0.8 - kWall) * 0.96;
  const double draught = (kMass / kDensity - a * kWall) / (kLength * kWidth - a);
  std::vector<double> water;
  for (const Hold& hold : body.shape->holds)
    water.push_back(std::abs(hold.centre.x()) < 0.1 ? a * (draught - kWall) : 0);
  setWater(body, water);
  const FloatingPose pose = floatAt(body, PackedHull(*body.shape), Vector3::UnitZ());
  EXPECT_NEAR(draught, 0.14787724, 1e-8);
  EXPECT_NEAR(pose.plane.height, draught, 1e-12);
  EXPECT_NEAR(pose.wet.volume, kMass / kDensity, 1e-12);
}

TEST(VesselStatics, LevelIsFoundToRoundingInFewClips) {
  const Vessel vessel = findHolds(makeBowl(0.2, 0.005), {}, "bowl");
  ASSERT_EQ(vessel.holds.size(), 1u);
  const HoldShape shape(vessel.holds[0]);
  const Vector3 tilted = Vector3(0.3, -0.2, 1).normalized();
  double guess = 0;
  for (const double share : {0.1, 0.5, 0.9, 0.91, 0.92}) {
    const HoldFill fill = fillHold(shape, tilted, share * shape.capacity(), guess);
    const WetVolume below = computeWetVolume(shape.hull(), {tilted, fill.height, 0, 0});
    EXPECT_NEAR(below.volume, share * shape.capacity(), 1e-12 * shape.capacity());
    EXPECT_EQ(fill.water.volume, share * shape.capacity());
    if (share > 0.9) {
      EXPECT_LE(fill.clips, 4) << share;
    }
    guess = fill.height;
  }
  EXPECT_EQ(fillHold(shape, tilted, 0, guess).water.waterplane.area, 0);
  const HoldFill full = fillHold(shape, tilted, shape.capacity(), guess);
  EXPECT_EQ(full.water.waterplane.area, 0);
  EXPECT_NEAR(full.water.volume, shape.capacity(), 1e-12 * shape.capacity());
}

TEST(VesselStatics, WaterThatDoesNotFitIsRefusedInOneLine) {
  FloatingBody body = afloat({}, 0.2);
  EXPECT_EQ(
      test::refusalOf<std::invalid_argument>([&] { setWater(body, {1}); }),
      "fluid body 'barge': water in its hold [m^3] is 1, must be zero or positive, and no more "
      "than it holds");
  EXPECT_EQ(
      test::refusalOf<std::invalid_argument>([&] {
        setWater(body, {0.1, 0.1});
      }),
      "fluid body 'barge': number of volumes of water is 2, must be at most that of its holds");
}

}  // namespace
}  // namespace ambient::test
