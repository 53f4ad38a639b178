#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "preprocess/floating/floating_body.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/holds/hold_search.h"
#include "preprocess/mesh/mass_properties.h"
#include "tests/preprocess/mesh/vessel_meshes.h"
#include "tests/support/refusal_of.h"

// Closed forms of naval architecture for a barge of 2 x 1 x 0.5 m with walls of 0.02 m and 200 kg
// in water of 1000 kg/m^3: wall-sided, with a free surface inside.
namespace ambient {
namespace {

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
}  // namespace ambient
