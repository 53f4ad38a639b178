#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;

const Medium kLiquid{1000, 1e-3, {0, 0, 0}, {0, 0, 0}};

std::shared_ptr<const FluidBody> roundBody(int level) {
  FluidBody body = test::hullBody(test::geodesicSphere(level));
  body.faces.sharpness = computeSharpness(body);
  makeSurfaceForm(body);
  return std::make_shared<const FluidBody>(body);
}

WetPart wetBelow(const Vector3& normal, double height, double share = 0.5) {
  return {{normal.normalized(), height, 1000, 9.81}, share};
}

double sizeOf(const Wrench& load) { return load.force.norm() + load.torque.norm(); }

std::vector<FlowSettings> allLaws() {
  std::vector<FlowSettings> laws;
  for (const PressureLaw law : {PressureLaw::kPublished, PressureLaw::kForm})
    for (const LoadPrecision precision : {LoadPrecision::kSingle, LoadPrecision::kDouble}) {
      laws.emplace_back();
      laws.back().law = law;
      laws.back().precision = precision;
    }
  return laws;
}

TEST(WetLoads, AreAllOrNothingFarFromTheSurface) {
  const Twist x{{0.3, -0.2, 0.5}, {1, 2, -0.7}};
  for (const FlowSettings& flow : allLaws()) {
    const auto loads = makeWaterlineLoads(roundBody(2), kLiquid, flow);
    const Wrench all = loads->load(x);
    const Wrench deep = loads->wetLoad(x, wetBelow({1, 2, 3}, 1.2, 1));
    // Form law: a body without a surface nearby takes its lee from sums made beforehand.
    const bool is_rounded =
        flow.law == PressureLaw::kForm && flow.precision == LoadPrecision::kSingle;
    const double rounding = is_rounded ? 3e-6 * sizeOf(all) : 0;
    EXPECT_LE((deep.force - all.force).norm(), rounding);
    EXPECT_LE((deep.torque - all.torque).norm(), rounding);
    EXPECT_EQ(sizeOf(loads->wetLoad(x, wetBelow({1, 2, 3}, -1.2, 0))), 0);
  }
}

TEST(WetLoads, OfBothSidesOfThePlaneMakeUpTheLoad) {
  Arbitrary arbitrary(1);
  for (FlowSettings flow : allLaws()) {
    flow.skin_friction =
        flow.law == PressureLaw::kPublished;  // that of the form law is of the whole
    const auto loads = makeWaterlineLoads(roundBody(2), kLiquid, flow);
    for (int i = 0; i < 20; ++i) {
      const Twist x = arbitrary.twist();
      const Wrench all = loads->load(x);
      WetPart wet = wetBelow(arbitrary.vector(), arbitrary.between(-1, 1));
      Wrench sum = loads->wetLoad(x, wet);
      wet.plane = wet.plane.flipped();
      sum += loads->wetLoad(x, wet);
      const double rounding = flow.precision == LoadPrecision::kSingle ? 1e-5 : 1e-13;
      EXPECT_LT((sum.force - all.force).norm(), rounding * sizeOf(all));
      EXPECT_LT((sum.torque - all.torque).norm(), rounding * sizeOf(all));
    }
  }
}

TEST(WetLoads, OfAHalfSubmergedBallAreThoseOfItsHalf) {
  FlowSettings flow;
  flow.law = PressureLaw::kPublished;  // has no suction in the lee
  flow.skin_friction = false;
  const auto loads = makeWaterlineLoads(roundBody(3), kLiquid, flow);
  const WetPart half = wetBelow({0, 0, 1}, 0);
  const Twist down{Vector3::Zero(), {0, 0, -2}}, up{Vector3::Zero(), {0, 0, 2}},
      along{Vector3::Zero(), {2, 0, 0}};
  // Attached flow on the lower side; faces at the waterline count half, with little pressure.
  const double full = loads->load(down).force.z();
  EXPECT_NEAR(loads->wetLoad(down, half).force.z(), full, 0.01 * full);
  EXPECT_NEAR(loads->wetLoad(up, half).force.z(), 0, 0.01 * full);
  EXPECT_NEAR(loads->wetLoad(along, half).force.x(), 0.5 * loads->load(along).force.x(),
              1e-3 * full);
}

TEST(WetLoads, TakeEnergyAtARightAngle) {
  Arbitrary arbitrary(2);
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;
  for (int i = 0; i < 50; ++i) {
    FluidBody body;
    body.faces = arbitrary.body();
    body.area = test::totalArea(body.faces);
    makeSurfaceForm(body);
    const auto loads = makeWaterlineLoads(std::make_shared<const FluidBody>(body), kLiquid, flow);
    const Twist x = arbitrary.twist();
    EXPECT_LE(power(loads->wetLoad(x, wetBelow(arbitrary.vector(), arbitrary.between(-1, 1))), x),
              0);
  }
}

TEST(WetLoads, ChangeLittleWhereTheSurfaceMovesLittle) {
  FluidBody box = test::boxBody({1, 1, 1}, 4);
  const auto loads = makeWaterlineLoads(std::make_shared<const FluidBody>(box), kLiquid, {});
  const Twist x{{0.1, 0, 0.2}, {0.5, 0.3, -1}};
  const double largest = sizeOf(loads->load(x));
  Wrench before{};
  for (int i = -700; i <= 700; ++i) {
    const Wrench now = loads->wetLoad(x, wetBelow({0, 0, 1}, 0.001 * i));
    // The flat bottom gets wet over 2/100 of its face radii, 0.1 m each.
    EXPECT_LT((now.force - before.force).norm(), 0.4 * largest) << 0.001 * i;
    before = now;
  }
}

std::shared_ptr<const FluidBody> sphereOf(double radius, const Vector3& centre = {0, 0, 0}) {
  FluidBody ball;
  ball.sphere_radius = radius;
  ball.area = 4 * kPi * radius * radius;
  ball.centre_of_volume = centre;
  return std::make_shared<const FluidBody>(ball);
}

TEST(WetLoads, AreSummedOverFacesWhereOthersHaveClosedForms) {
  EXPECT_LT(makeSurfaceLoads(sphereOf(1), kLiquid, {})->faces(), 17);
  EXPECT_EQ(makeWaterlineLoads(sphereOf(1), kLiquid, {})->faces(), 1152);
}

// All spheres take them from faces of one sphere, with lengths in radii.
TEST(WetLoads, OfASphereInTheFluidAreItsClosedForm) {
  const Vector3 centre(0.3, -0.1, 0.2);
  const auto body = sphereOf(0.4, centre);
  const Twist x{{0.7, -0.3, 0.5}, {0.3, 0.2, -0.4}};
  for (FlowSettings flow : allLaws())
    for (const double angle : {kPi / 2, 2.0, kPi}) {
      flow.separation_angle = angle;
      const auto loads = makeWaterlineLoads(body, kLiquid, flow);
      const FaceLoads exact = makeSurfaceLoads(body, kLiquid, flow)->parts(x);
      const FaceLoads deep = loads->wetParts(x, wetBelow({1, 2, 3}, 0.9, 1));
      // Discretisation by 1152 faces.
      const double size = 0.5 * kLiquid.density * x.linear.squaredNorm() * kPi * 0.16;
      EXPECT_LT((deep.pressure + -1.0 * exact.pressure).force.norm(), 0.01 * size);
      EXPECT_LT(sizeOf(deep.friction + -1.0 * exact.friction), 0.02 * sizeOf(exact.friction));
      EXPECT_EQ(loads->frame({}).translation, centre);
    }
}

TEST(WetLoads, OfASphereEndAtTheSidesOfAPool) {
  const Vector3 centre(2, 0, 0);
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;
  Medium ideal = kLiquid;
  ideal.viscosity = 0;
  const auto loads = makeWaterlineLoads(sphereOf(0.4, centre), ideal, flow);
  const Twist x{{0, 0, 0}, {0, 0, -1}};
  PoolSides sides;
  sides.count = 1;
  WetPart wet = wetBelow({0, 0, 1}, 0.9, 1);
  const double whole = loads->wetLoad(x, wet).force.z();
  wet.plane.sides_F = &sides;
  const auto shareBeside = [&](double place) {
    sides.of[0] = {Vector3::UnitX(), {place, 0, 0}};
    return loads->wetLoad(x, wet).force.z() / whole;
  };
  EXPECT_EQ(shareBeside(1.59), 0);
  EXPECT_NEAR(shareBeside(2), 0.5, 1e-12);
  EXPECT_EQ(shareBeside(2.41), 1);
}

TEST(WetLoads, OfAnotherLawAreTheShareOfTheVolume) {
  struct Constant final : SurfaceLoads {
    Wrench load(const Twist&) const noexcept override { return {{1, 2, 3}, {4, 5, 6}}; }
  };
  FlowSettings flow;
  flow.own_law = [](const auto&, const LoadSettings&) { return std::make_shared<Constant>(); };
  const auto loads = makeWaterlineLoads(roundBody(0), kLiquid, flow);
  EXPECT_EQ(loads->wetLoad({}, wetBelow({0, 0, 1}, 0, 0.25)).force, Vector3(1, 1.25, 1.5));
}

TEST(WetLoads, OfASphereInAttachedFlowAreFrictionAlone) {
  // Pressure on half of a sphere would be even in the velocity, about rho v^2 R^2 pi / 4. The
  // gradient of the added mass contains this force already.
  FluidBody sphere = test::hullBody(test::geodesicSphere(3));
  sphere.sphere_radius = 1;
  const auto body = std::make_shared<const FluidBody>(sphere);
  FlowSettings flow;
  flow.law = PressureLaw::kPublished;
  flow.separation_angle = std::acos(-1.0);
  const auto loads = makeWaterlineLoads(body, kLiquid, flow);
  for (const Vector3& v : {Vector3(0, 0, 2), Vector3(1, 0, -1)}) {
    const Wrench there = loads->wetLoad({{0, 0, 0}, v}, wetBelow({0, 0, 1}, 0));
    const Wrench back = loads->wetLoad({{0, 0, 0}, -v}, wetBelow({0, 0, 1}, 0));
    const double pressure = 1000 * v.squaredNorm();
    EXPECT_LT(power(there, {{0, 0, 0}, v}), 0);
    EXPECT_LT(sizeOf(there), 0.02 * pressure);
    EXPECT_LT(sizeOf(there + back), 1e-5 * pressure);
  }
  flow.skin_friction = false;
  const auto pressure = makeWaterlineLoads(body, kLiquid, flow);
  EXPECT_LT(sizeOf(pressure->wetLoad({{0, 0, 0}, {1, 2, 3}}, wetBelow({0, 0, 1}, 0))), 0.1);
}

TEST(WetLoads, InAttachedFlowHaveTheShareOfThePressureOnTheWhole) {
  const Twist x{{0.3, -0.2, 0.5}, {1, 2, -0.7}};
  FluidBody sphere = test::hullBody(test::geodesicSphere(3));
  sphere.sphere_radius = 1;
  for (FlowSettings flow : allLaws()) {
    if (flow.law == PressureLaw::kForm) continue;  // knows no angle
    flow.separation_angle = std::acos(-1.0);
    for (const auto& body : {roundBody(2), std::make_shared<const FluidBody>(sphere)}) {
      // Deep below the surface the loads are complete.
      const auto loads = makeWaterlineLoads(body, kLiquid, flow);
      const Wrench deep = loads->wetLoad(x, wetBelow({1, 2, 3}, 1.2, 1));
      const Wrench all = makeSurfaceLoads(body, kLiquid, flow)->load(x);
      EXPECT_LT(sizeOf(deep + -1.0 * all), (body->sphere_radius > 0 ? 0.01 : 1e-5) * sizeOf(all));
      flow.skin_friction = false;
      const auto pressure = makeWaterlineLoads(body, kLiquid, flow);
      const Wrench whole = makeSurfaceLoads(body, kLiquid, flow)->load(x);
      const Wrench half = pressure->wetLoad(x, wetBelow({1, 2, 3}, 0.1));
      EXPECT_GT(sizeOf(whole), 1000);
      EXPECT_LT(sizeOf(half + -0.5 * whole), 1e-5 * sizeOf(whole));
    }
  }
}

}  // namespace
}  // namespace ambient
