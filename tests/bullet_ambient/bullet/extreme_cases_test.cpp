#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/contact/uneven_body.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/sphere_fall.h"
#include "tests/support/bodies/part_bodies.h"

// Stiff and extreme cases, each against an exact solution or a bound.
namespace ambient::test {
namespace {

constexpr double kEarthGravity = 9.81;

Medium inviscid(Medium medium) {
  medium.viscosity = 0;
  return medium;
}

BodyDef sphere(double mass, double radius) {
  return {mass, Vector3::Constant(0.4 * mass * radius * radius), {}, nullptr};
}

void setGravity(FluidWorld& scene, double gravity) {
  scene.world.setGravity({0, 0, static_cast<btScalar>(-gravity)});
}

double speedOf(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().length());
}

/// Speed of a sphere at a time without gravity: K dv/dt = -c v^2.
double coastingSpeed(const reference::SphereFall& s, double start, double time) {
  const double c = s.density * kPi * s.radius * s.radius * s.drag_coefficient / 2;
  return start / (1 + c / s.effectiveMass() * start * time);
}

TEST(ExtremeCase, AFeatherAt300MetresPerSecondIsSlowedAsItsDragSays) {
  // 0.2 g, 4 cm radius: loses nine tenths of its speed within the first step.
  const reference::SphereFall exact{2e-4, 0.04, air().density, 0};
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    FluidWorld scene;
    BodyDef def = sphere(exact.mass, exact.radius);
    def.start.twist.linear = {0, 0, 300};
    btRigidBody& feather = scene.add(def);
    AttachDef attach{std::make_shared<FluidBody>(gaussSphere(exact.radius)), inviscid(air())};
    // No face lies at the rim of the sphere. So sideways drift by rounding grows while the sphere
    // slows down, their product constant: 5e-6 with loads in single precision.
    attach.flow.precision = LoadPrecision::kDouble;
    scene.fluid.add(feather, attach);
    for (int i = 1; i <= 30; ++i) {
      scene.step(step);
      EXPECT_NEAR(speedOf(feather) / coastingSpeed(exact, 300, i * step), 1,
                  byPrecision(1e-12, 2e-5))
          << "step " << i << " of " << step;
    }
  }
}

TEST(ExtremeCase, ATumblingFeatherAt300MetresPerSecondOnlyLosesEnergy) {
  const Vector3 semi_axes(0.05, 0.05, 0.01);
  BodyDef def{2e-4, ellipsoidMoments(semi_axes, 2e-4),
              startWith({Vector3(100, 50, 20), Vector3(300, 0, 200)})};
  FluidWorld scene;
  const btRigidBody& feather = scene.add(def, meshedEllipsoid(semi_axes, 2), air());
  double energy = kineticEnergy(scene, feather);
  for (int i = 0; i < 240; ++i) {
    scene.step(1.0 / 60);
    const double now = kineticEnergy(scene, feather);
    ASSERT_LE(now, energy * (1 + byPrecision(1e-12, 1e-5))) << i;
    energy = now;
  }
  EXPECT_LT(speedOf(feather), 3);
  // Its first steps are too long for the paths that they stand for, and the user is told, once.
  EXPECT_GT(scene.of(feather).counters().coarse, 0);
  ASSERT_EQ(scene.said.size(), 1U);
  EXPECT_NE(scene.said[0].find("too long for the motion"), std::string::npos);
}

TEST(ExtremeCase, AFastModeThatWasAskedForIsNotComplainedAbout) {
  FluidWorld scene;
  AttachDef attach{std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.05, 0.05, 0.01), 1)),
                   air()};
  attach.flight.max_substeps = 1;
  btRigidBody& feather = scene.add({2e-4, ellipsoidMoments(Vector3(0.05, 0.05, 0.01), 2e-4),
                                    startWith({Vector3(100, 50, 20), Vector3(300, 0, 200)})});
  scene.fluid.add(feather, attach);
  scene.step(1.0 / 60, 60);
  const AmbientCounters counters = scene.of(feather).counters();
  EXPECT_GT(counters.coarse, 0);
  EXPECT_EQ(counters.substeps, 60);
  EXPECT_LE(counters.load_evaluations, 61);
  EXPECT_TRUE(scene.said.empty()) << scene.said[0];
}

struct SpunCoin {
  double spin;                  // [rad/s]
  double spin_axis, coin_axis;  // cosines to initial directions
};

// Spins a coin of 5.7 g for two seconds.
SpunCoin spinCoin(const FluidBody& shape, double step) {
  const Vector3 semi_axes(0.012, 0.012, 0.001);
  BodyDef def{0.0057, ellipsoidMoments(semi_axes, 0.0057), {}, nullptr};
  def.start.orientation = Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitX()));
  const Vector3 axis = def.start.orientation * Vector3::UnitZ();
  def.start.twist.angular = 1e4 * axis;
  FluidWorld scene;
  const btRigidBody& coin = scene.add(def, shape, inviscid(air()));
  scene.step(step, static_cast<int>(std::lround(2 / step)));
  const Vector3 spin = toVector3(coin.getAngularVelocity());
  return {spin.norm(), spin.normalized().dot(axis),
          (readState(coin).orientation * Vector3::UnitZ()).dot(axis)};
}

TEST(ExtremeCase, ASmoothCoinSpunAtTenThousandRadiansPerSecondKeepsAxisAndSpin) {
  for (const double step : {1.0 / 30, 1.0 / 240}) {
    const SpunCoin end = spinCoin(facelessEllipsoid(Vector3(0.012, 0.012, 0.001)), step);
    EXPECT_NEAR(end.spin / 1e4, 1, byPrecision(1e-12, 1e-4));
    EXPECT_GT(end.spin_axis, 1 - byPrecision(1e-12, 1e-4));
    EXPECT_GT(end.coin_axis, 1 - byPrecision(1e-12, 1e-4));
  }
}

TEST(ExtremeCase, AFacetedCoinSpunAtTenThousandRadiansPerSecondIsSlowedByItsFacetsAlone) {
  // Facets turning about the axis brake the spin: measured 2 and 7 per cent in two seconds.
  for (const double step : {1.0 / 30, 1.0 / 240}) {
    const SpunCoin end = spinCoin(meshedEllipsoid(Vector3(0.012, 0.012, 0.001), 2), step);
    EXPECT_LT(end.spin, 1e4);
    EXPECT_GT(end.spin, 0.9e4);
    EXPECT_GT(end.spin_axis, std::cos(0.03));
    EXPECT_GT(end.coin_axis, std::cos(0.03));
  }
}

TEST(ExtremeCase, ABodyFiredOutOfContactFliesByItsClosedForm) {
  constexpr double kRadius = 0.1, kSpeed = 100;
  btBoxShape floor_shape(btVector3(5, 5, 1));
  btSphereShape ball_shape(static_cast<btScalar>(kRadius));
  FluidWorld scene;
  setGravity(scene, kEarthGravity);
  scene.add({0, Vector3::Zero(), startAt({0, 0, -1}), &floor_shape});
  BodyDef def = sphere(0.5, kRadius);
  def.start.position = {0, 0, kRadius};
  def.shape = &ball_shape;
  btRigidBody& ball = scene.add(def, gaussSphere(kRadius), inviscid(water()));
  ball.setMassProps(static_cast<btScalar>(8), toBullet(Vector3::Constant(0.032)));
  scene.step(1.0 / 240, 240);
  ASSERT_NEAR(speedOf(ball), 0, 1e-3);  // rests on the floor
  ball.setLinearVelocity({0, 0, static_cast<btScalar>(kSpeed)});
  scene.step(1.0 / 240, 24);
  // K dv/dt = -c v^2 - (m - m_f) g: v = v_t tan(atan(v_0 / v_t) - t / T).
  const reference::SphereFall exact{8, kRadius, water().density, kEarthGravity};
  const double v = exact.terminalSpeed() *
                   std::tan(std::atan(kSpeed / exact.terminalSpeed()) - 0.1 / exact.settlingTime());
  EXPECT_NEAR(static_cast<double>(ball.getLinearVelocity().z()) / v, 1, 1e-3);
}

TEST(ExtremeCase, AStepOfAQuarterOfASecondAfterAStallChangesLittle) {
  const reference::SphereFall exact{0.62, 0.12, air().density, kEarthGravity};
  FluidWorld scene;
  setGravity(scene, kEarthGravity);
  const btRigidBody& ball =
      scene.add(sphere(exact.mass, exact.radius), gaussSphere(exact.radius), inviscid(air()));
  scene.step(1.0 / 60, 30);
  scene.step(0.25);
  scene.step(1.0 / 60, 15);
  EXPECT_NEAR(static_cast<double>(-ball.getLinearVelocity().z()) / exact.velocity(1), 1, 2e-3);
  EXPECT_NEAR(static_cast<double>(-ball.getWorldTransform().getOrigin().z()) / exact.distance(1), 1,
              5e-3);
}

TEST(ExtremeCase, AMediumThatJumpsBetweenAirAndWaterNeverSpeedsABodyUp) {
  const Vector3 semi_axes(0.2, 0.15, 0.05);
  BodyDef def{1, ellipsoidMoments(semi_axes, 1), startWith({Vector3(3, 9, 4), Vector3(10, 3, 5)})};
  FluidWorld scene;
  const btRigidBody& body = scene.add(def, meshedEllipsoid(semi_axes, 2), air());
  for (int i = 0; i < 240; ++i) {
    const double before = kineticEnergy(scene, body);
    scene.step(1.0 / 60);
    ASSERT_LE(kineticEnergy(scene, body), before * (1 + byPrecision(1e-12, 1e-5))) << i;
    const RigidState state = readState(body);
    scene.of(body).setMedium(i % 2 ? air() : water());
    ASSERT_EQ(readState(body).twist.vector(), state.twist.vector());
  }
  EXPECT_LT(speedOf(body), 1);
}

TEST(ExtremeCase, ABodyAMillionTimesHeavierKicksItsNeighbourAway) {
  constexpr double kRadius = 0.1;
  const Medium medium = inviscid(air());
  btSphereShape ball_shape(static_cast<btScalar>(kRadius));
  FluidWorld scene;
  BodyDef heavy_def = sphere(1000, kRadius);
  heavy_def.shape = &ball_shape;
  heavy_def.start.twist.linear = {5, 0, 0};
  btRigidBody& heavy = scene.add(heavy_def, facelessEllipsoid(Vector3::Constant(kRadius)), medium);
  BodyDef light_def = sphere(1e-3, kRadius);
  light_def.shape = &ball_shape;
  // Initial contact: Bullet spreads an impact from a distance over two steps.
  light_def.start.position = {2 * kRadius, 0, 0};
  btRigidBody& light = scene.add(light_def, facelessEllipsoid(Vector3::Constant(kRadius)), medium);
  for (btRigidBody* body : {&heavy, &light}) {
    body->setRestitution(1);
    body->setFriction(0);
  }
  scene.step(1.0 / 240, 24);
  // Elastic, head on: v = 2 K1 / (K1 + K2) of the approach, with added masses.
  const double k1 = scene.of(heavy).inertia()(3, 3), k2 = scene.of(light).inertia()(3, 3);
  EXPECT_NEAR(static_cast<double>(light.getLinearVelocity().x()) / (2 * k1 / (k1 + k2) * 5), 1,
              byPrecision(1e-9, 1e-4));
  EXPECT_NEAR(static_cast<double>(heavy.getLinearVelocity().x()) / 5, (k1 - k2) / (k1 + k2),
              byPrecision(1e-9, 1e-5));
}

constexpr double kFallRadius = 0.12;

double fallSpeed(const btRigidBody& body) {
  return -static_cast<double>(body.getLinearVelocity().z());
}

double fallDistance(const btRigidBody& body) {
  return -static_cast<double>(body.getWorldTransform().getOrigin().z());
}

// Spheres from a balloon in water to a basketball in air.
TEST(ExtremeCase, ASphereFollowsItsClosedForm) {
  for (const double mass : {0.01, 0.62, 4.3}) {
    const Medium medium = mass < 0.1 ? water() : air();
    const reference::SphereFall exact{mass, kFallRadius, medium.density, kEarthGravity};
    const double duration = 2 * exact.settlingTime();
    double errors[2];
    for (int k = 0; k < 2; ++k) {
      FluidWorld scene;
      setGravity(scene, kEarthGravity);
      const btRigidBody& body = scene.add(sphere(mass, kFallRadius), gaussSphere(kFallRadius),
                                          inviscid(medium), PressureLaw::kPublished);
      const int steps = 100 << (2 * k);
      scene.step(duration / steps, steps);
      errors[k] = std::abs(fallDistance(body) / exact.distance(duration) - 1);
      EXPECT_NEAR(fallSpeed(body) / exact.velocity(duration), 1, byPrecision(1e-4, 1e-4));
    }
    // Order 2 in the step, down to the rounding of the position.
    EXPECT_LT(errors[0], 2e-4);
    EXPECT_LT(errors[1], errors[0] / 10 + byPrecision(1e-12, 2e-5));
  }
}

FluidBody smoothBall() {
  FluidBody ball = floatingEllipsoid(Vector3::Constant(kFallRadius), 2);
  ball.sphere_radius = kFallRadius;
  return ball;
}

// By the form law the wake has to develop first, eq. (51b) to (51d).
TEST(ExtremeCase, FallsFasterUntilItsWakeHasDeveloped) {
  const auto speedAfter = [&](double time, PressureLaw law) {
    FluidWorld scene;
    setGravity(scene, kEarthGravity);
    const btRigidBody& body =
        scene.add(sphere(12, kFallRadius), smoothBall(), inviscid(water()), law);
    scene.step(1.0 / 240, static_cast<int>(240 * time));
    return fallSpeed(body);
  };
  const double early = speedAfter(0.4, PressureLaw::kForm);
  EXPECT_GT(early, 1.02 * speedAfter(0.4, PressureLaw::kPublished));
  EXPECT_LT(early, 0.4 * kEarthGravity);
  const double section = kPi * kFallRadius * kFallRadius,
               net = 12 - water().density * 4.0 / 3 * section * kFallRadius;
  const double late = std::sqrt(4 * net * kEarthGravity / (water().density * section));  // C_D 1/2
  EXPECT_NEAR(speedAfter(6, PressureLaw::kForm), late, 1e-3 * late);
}

TEST(ExtremeCase, WakesAreSavedAndRestored) {
  FluidWorld scene;
  setGravity(scene, kEarthGravity);
  const btRigidBody& body = scene.add(sphere(2, kFallRadius), smoothBall(), water());
  scene.step(1.0 / 120, 10);
  WorldState state = scene.fluid.save();
  const auto heightAfter = [&] {
    scene.step(1.0 / 120, 10);
    return body.getWorldTransform().getOrigin().z();
  };
  const btScalar first = heightAfter();
  scene.fluid.restore(state);
  EXPECT_EQ(heightAfter(), first);
  state.bodies[0].ambient->wake = {};
  scene.fluid.restore(state);
  EXPECT_NE(heightAfter(), first);
}

}  // namespace
}  // namespace ambient::test
