#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/wind.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/threads.h"

// Worlds in layers of density, wind profiles, gusts and turbulence: docs/theory.md section 23.
namespace ambient::test {
namespace {

constexpr double kLayerDensity = 1000, kSlope = -20;  // [kg/m^3], [kg/m^4]

FluidRegion stratifiedTank() {
  FluidRegion tank = filledWith(idealFluid(kLayerDensity));
  tank.layers = layers({{-10, kLayerDensity - 10 * kSlope}, {10, kLayerDensity + 10 * kSlope}});
  return tank;
}

// A ball without loads that weighs as much as the fluid at z = 0.
btRigidBody& addFloat(FluidWorld& scene, const Vector3& start) {
  constexpr double kRadius = 0.2;
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(kRadius));
  const double mass = kLayerDensity * shape.volume;
  btRigidBody& body = scene.add(
      {mass, ellipsoidMoments(Vector3::Constant(kRadius), mass), startAt(start)}, shape, Medium{});
  body.setGravity({0, 0, bt(-kGravity)});
  return body;
}

// Buoyancy frequency with the added mass of a ball, C_a = 1/2.
TEST(Layers, ANeutralFloatBobsWithTheBuoyancyFrequency) {
  const double frequency = std::sqrt(-kGravity * kSlope / kLayerDensity / 1.5);
  for (const double step : {1.0 / 60, 1.0 / 10}) {
    SeaWorld scene(stratifiedTank());
    const btRigidBody& body = addFloat(scene, {0, 0, 0.5});
    double last = 0.5, first = 0, crossing = 0;
    int crossings = 0;
    for (int i = 1; crossings < 21; ++i) {
      ASSERT_LT(i * step, 400);
      scene.step(step);
      const double now = heightOf(body);
      if ((now < 0) != (last < 0)) {
        crossing = step * (i - now / (now - last));
        if (crossings++ == 0) first = crossing;
      }
      last = now;
    }
    const double found = 20 * kPi / (crossing - first);
    EXPECT_NEAR(found, frequency, 1e-3 * frequency);
    // Ten periods neither damp it nor drive it.
    double highest = 0;
    for (int i = 0; i * step < 2 * kPi / frequency; ++i, scene.step(step))
      highest = std::max(highest, heightOf(body));
    EXPECT_NEAR(highest, 0.5, 2e-3);
  }
}

// A sharp interface at the centre of a box: the mean of both densities.
TEST(Layers, BuoyancyIsThatOfTheVolume) {
  FluidRegion tank = filledWith(idealFluid(kLayerDensity));
  tank.layers = layers({{0, 1100}, {0, 1000}});
  SeaWorld scene(tank);
  const btRigidBody& body = scene.addBox(kBoxSize, 100);
  scene.of(body).readWrench(true);
  scene.step(1e-4);
  const double expected = 1050 * kBoxSize.prod() * kGravity;
  EXPECT_NEAR(scene.of(body).wrench().buoyancy.force.z(), expected, 1e-5 * expected);
}

// Drag goes with the density of the place.
TEST(Layers, LoadsGoWithTheDensity) {
  const auto dragAt = [](double height) {
    SeaWorld scene(stratifiedTank());
    RigidState start;
    start.position.z() = height;
    start.twist.linear.x() = 2;
    const btRigidBody& body = scene.addBox({1, 0.5, 0.5}, 250, start, 4);
    scene.of(body).readWrench(true);
    scene.step(1e-6);
    return scene.of(body).wrench().pressure.force.x();
  };
  EXPECT_NEAR(dragAt(5) / dragAt(0), 0.9, 1e-6);
}

// A box floats in two layers under a surface: its weight is the water that it displaces.
TEST(Layers, ABodyAtTheSurfaceDisplacesItsWeight) {
  FluidRegion lake = seaUnderAir();
  lake.below.density = 1000;
  lake.layers = layers({{-1, 1200}, {-0.1, 1200}, {-0.1, 1000}, {0, 1000}});
  SeaWorld scene(lake);
  // 0.1 m in 1000 and 0.1 m in 1200 kg/m^3.
  const double mass = kBoxSize.x() * kBoxSize.y() * (0.1 * 1000 + 0.1 * 1200);
  const btRigidBody& body = scene.addBox(kBoxSize, mass);
  scene.step(1.0 / 120, 120 * 30);
  EXPECT_NEAR(heightOf(body), kBoxSize.z() / 2 - 0.2, 1e-3);  // the air carries some, too
}

Turbulence eddiesAbout(double length) {
  Turbulence eddies;
  eddies.length = length;
  eddies.intensity = 0.3;
  eddies.carried = {0.5, 0, 0};
  return eddies;
}

// A ball as heavy as its fluid that feels no loads goes with the particle that it began with:
// displaced and added mass get the acceleration of the fluid, exactly.
TEST(Turbulence, CarriesANeutralBallAsItsOwnParticle) {
  FluidRegion region = filledWith(idealFluid(kLayerDensity));
  WindProfile shear;
  shear.velocity = {0.4, 0.3, 0};
  shear.ground = -10;
  region.flow = turbulence(eddiesAbout(5)) + windProfile(shear);
  region.below.velocity = {0.2, 0, 0.1};
  double errors[2];
  for (int halving = 0; halving < 2; ++halving) {
    const double step = 0.002 / (1 + halving);
    FluidWorld scene;
    scene.fluid.addRegion(region);
    btRigidBody& body = addFloat(scene, {0, 0, 0});
    body.setGravity({0, 0, 0});
    const auto fluidAt = [&region](const Vector3& point, double time) -> Vector3 {
      return region.below.velocity + region.flow(point, time).velocity;
    };
    body.setLinearVelocity(toBullet(fluidAt({0, 0, 0}, 0)));
    scene.step(step, static_cast<int>(std::lround(4 / step)));
    Vector3 particle(0, 0, 0);
    constexpr double kFine = 1e-3;
    for (int i = 0; i < 4000; ++i) {
      const Vector3 half = particle + kFine / 2 * fluidAt(particle, i * kFine);
      particle += kFine * fluidAt(half, (i + 0.5) * kFine);
    }
    errors[halving] = (toVector3(body.getWorldTransform().getOrigin()) - particle).norm();
  }
  EXPECT_LT(errors[0], 0.02) << "of a way of 3 m";
  EXPECT_NEAR(errors[1] / errors[0], 0.5, 0.1) << "first order: samples are of the step's start";
}

/// A surface over layers, in all that blows.
FluidRegion windySea() {
  FluidRegion sea = seaUnderAir();
  WindProfile wind;
  wind.velocity = {8, 0, 0};
  wind.roughness = 2e-4;
  sea.flow_above = windProfile(wind) + drydenGusts({});
  sea.flow = turbulence(eddiesAbout(5));
  sea.layers = layers({{-3, 1030}, {-0.1, 1000}});
  return sea;
}

struct WindyWorld : SeaWorld {
  WindyWorld() : SeaWorld(windySea()) {
    for (int i = 0; i < 12; ++i) {
      RigidState start;
      start.position.x() = 3.0 * i;
      bodies.push_back(&addBox(kBoxSize, 60.0 + 20 * i, start, 4));
    }
  }
  std::vector<btRigidBody*> bodies;
};

TEST(Gusts, GoOnWithTheSameBitsAfterARestore) {
  WindyWorld scene, other;
  scene.step(kSceneStep, 40);
  const auto runOf = [](WindyWorld& world) {
    return SavedRun{world.fluid, [&world] { world.step(kSceneStep); }};
  };
  expectGoesOn(runOf(scene), runOf(scene), 30);
  expectGoesOn(runOf(scene), runOf(other), 30);
}

TEST(Gusts, HaveTheSameBitsOnAnyNumberOfThreads) {
  WindyWorld alone, together;
  together.fluid.setTaskRunner(onThreads(3));
  alone.step(kSceneStep, 60);
  together.step(kSceneStep, 60);
  for (std::size_t i = 0; i < alone.bodies.size(); ++i)
    EXPECT_TRUE(moveAlike(*alone.bodies[i], *together.bodies[i])) << i;
}

// A link of a multibody in layers is lifted as a rigid body is.
TEST(Layers, LiftLinksAsBodies) {
  const auto rise = [](bool is_link) {
    RobotWorld scene;
    scene.world.setGravity({0, 0, bt(-kGravity)});
    FluidRegion tank = filledWith(idealFluid(kLayerDensity));
    tank.layers = layers({{-1, 1200}, {1, 1200}});
    scene.fluid.addRegion(tank);
    AttachDef attach{longBox(kBoxSize, 2)};
    const double mass = 210;  // sinks in the medium, rises in the layers
    const btVector3 moments = toBullet(boxMoments(kBoxSize, mass));
    btEmptyShape no_shape;
    if (!is_link) {
      btRigidBody& body = scene.contents.add(mass, moments, no_shape, btTransform::getIdentity());
      body.setGravity({0, 0, bt(-kGravity)});
      scene.fluid.add(body, attach);
      scene.step(1.0 / 60, 10);
      return heightOf(body);
    }
    auto robot = std::make_unique<btMultiBody>(0, bt(mass), moments, false, false);
    robot->finalizeMultiDof();
    btMultiBody& tree = scene.takeUndamped(std::move(robot));
    scene.fluid.add(tree, -1, attach);
    scene.step(1.0 / 60, 10);
    return static_cast<double>(tree.getBasePos().z());
  };
  EXPECT_GT(rise(false), 0.003);
  EXPECT_NEAR(rise(true), rise(false), 1e-3 * rise(false));
}

// A boat with its centre of mass below the water drifts with the wind on its dry part; the water
// does not move with it.
TEST(Gusts, WindOverTheSurfaceIsThatOfTheDryPart) {
  const auto speedIn = [](const FlowField& above, const FlowField& all) {
    FluidRegion sea = seaUnderAir();
    sea.flow_above = above;
    sea.flow = all;
    SeaWorld scene(sea);
    const btRigidBody& body = scene.addBox(kBoxSize, 600 * kBoxSize.prod(), {}, 4);
    scene.step(1.0 / 60, 600);
    return static_cast<double>(body.getLinearVelocity().x());
  };
  WindProfile wind;
  wind.velocity = {20, 0, 0};
  wind.roughness = 2e-4;
  // The box is dry up to 0.16 m: the wind is that at 0.08 m.
  const double there = 20 * std::log(0.08 / 2e-4) / std::log(10 / 2e-4);
  const auto even = [there](const Vector3&, double) { return FlowSample{{there, 0, 0}}; };
  const double drift = speedIn(windProfile(wind), nullptr);
  EXPECT_GT(drift, 0.02);
  EXPECT_NEAR(drift, speedIn(even, nullptr), 0.05 * drift);
  EXPECT_GT(speedIn(nullptr, even), 5) << "blows in the water, too";
}

// The change of the energy of a box is the work of its loads, of the accelerating air and of
// gravity.
TEST(Gusts, ABoxInWindKeepsItsEnergyBalance) {
  FluidRegion air_around = filledWith(ambient::air());
  WindProfile wind;
  wind.velocity = {8, 2, 0};
  wind.ground = -20;
  air_around.flow = windProfile(wind) + turbulence(eddiesAbout(20));
  SeaWorld scene(air_around);
  const double mass = 5;
  const Vector3 moments = boxMoments(kBoxSize, mass);
  const RigidState start = startWith({Vector3(1, 2, 3), Vector3(0, 0, 5)});
  const btRigidBody& body = scene.addBox(kBoxSize, mass, start, 4);
  scene.of(body).readWrench(true);
  const auto energy = [&] {
    const Twist x = ambient::velocityOf(body);
    const Matrix3 R = toQuaternion(body.getOrientation()).toRotationMatrix();
    return (mass * x.linear.squaredNorm() + (R.transpose() * x.angular).cwiseAbs2().dot(moments)) /
               2 +
           mass * kGravity * heightOf(body);
  };
  double work = 0;
  const double before = energy(), step = 1.0 / 480;
  double taken = 0;
  for (int i = 0; i < 480; ++i) {
    const Twist start = ambient::velocityOf(body);
    scene.step(step);
    const Twist end = ambient::velocityOf(body);
    const Wrench total = scene.of(body).wrench().total();
    const double part = step / 2 *
                        (total.force.dot(start.linear + end.linear) +
                         total.torque.dot(start.angular + end.angular));
    work += part;
    taken += std::abs(part);
  }
  EXPECT_GT(taken, 10);
  EXPECT_NEAR(energy() - before, work, 1e-3 * taken);
}

}  // namespace
}  // namespace ambient::test
