#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

// The wrench of the fluid where closed forms tell it, and what its reading may not do.

constexpr double kG = 9.81;

struct Swimmer {
  explicit Swimmer(double specific_gravity, const Medium& medium = {}) {
    scene.world.setGravity({0, 0, bt(-kG)});
    shape = std::make_shared<FluidBody>(floatingEllipsoid(kUnequalAxes, 3));
    shape->name = "swimmer";
    def.mass = specific_gravity * 1000 * shape->volume;
    def.moments = ellipsoidMoments(kUnequalAxes, def.mass);
    attach.fluid_body = shape;
    attach.medium = medium;
  }
  Immersed add() {
    body = &scene.add(def);
    return scene.fluid.add(*body, attach);
  }

  FluidWorld scene;
  std::shared_ptr<FluidBody> shape;
  BodyDef def;
  AttachDef attach;
  btRigidBody* body = nullptr;
};

Medium stillWater() { return {1000, 1e-3, {0, 0, 0}, {0, 0, 0}}; }

TEST(WrenchReading, TheWaterCarriesAFloatingBody) {
  Swimmer swimmer(0.5);
  swimmer.scene.fluid.addRegion(waterBelow(0));
  const Immersed body = swimmer.add();
  body.readWrench(true);
  swimmer.scene.step(1.0 / 60, 3600);
  const FluidWrench read = body.wrench();
  EXPECT_NEAR(read.buoyancy.force.z() / (swimmer.def.mass * kG), 1, 1e-3);
  EXPECT_NEAR(read.total().force.z() / (swimmer.def.mass * kG), 1, 1e-6);
  EXPECT_EQ(read.constraints.vector().norm(), 0);
}

TEST(WrenchReading, IsThatOfPoseAndVelocityBeforeAStep) {
  Swimmer swimmer(0.5);
  swimmer.scene.fluid.addRegion(waterBelow(0));
  const Immersed body = swimmer.add();
  body.readWrench(true);
  const double draughted = body.wet().volume * water().density * kG;
  EXPECT_NEAR(body.wrench().buoyancy.force.z() / draughted, 1, 2e-3);  // and the air's
  EXPECT_EQ(body.wrench().constraints.vector().norm(), 0);
  body.readWrench(false);
  swimmer.body->setLinearVelocity({2, 0, 0});
  body.readWrench(true);
  EXPECT_LT(body.wrench().pressure.force.x(), 0);
  EXPECT_EQ(body.wrench().added_mass.vector().norm(), 0);
}

TEST(WrenchReading, TellsTheEnergyOfBodyAndWater) {
  Swimmer swimmer(1, stillWater());
  const Immersed body = swimmer.add();
  const Matrix6 K = body.inertia();
  const Vector6 x = stack(Vector3(1, -2, 0.5), Vector3(3, 0, 1));
  swimmer.body->setAngularVelocity({1, -2, bt(0.5)});
  swimmer.body->setLinearVelocity({3, 0, 1});
  EXPECT_NEAR(body.kineticEnergy() / (x.dot(K * x) / 2), 1, byPrecision(1e-12, 1e-6));
  Medium current = stillWater();
  current.velocity = {3, 0, 1};
  body.setMedium(current);
  swimmer.body->setAngularVelocity({0, 0, 0});  // drifts with the water
  EXPECT_NEAR(body.kineticEnergy() / (swimmer.def.mass * 10 / 2), 1, byPrecision(1e-12, 1e-5));
}

TEST(WrenchReading, DragAndBuoyancyCarryASinkingBody) {
  Swimmer swimmer(2, stillWater());
  const Immersed body = swimmer.add();
  body.readWrench(true);
  swimmer.scene.step(1.0 / 240, 4800);
  const FluidWrench read = body.wrench();
  const double lift = swimmer.def.mass * kG / 2;
  EXPECT_NEAR(read.buoyancy.force.z() / lift, 1, byPrecision(1e-12, 1e-6));
  EXPECT_NEAR((read.pressure.force + read.friction.force).z() / lift, 1, 2e-2);
  EXPECT_GT(read.friction.force.z(), 0);
  EXPECT_LT(read.friction.force.z(), read.pressure.force.z());
}

// Let go at rest: the added mass takes K_f / K of the force.
TEST(WrenchReading, TheAddedMassHoldsBackABodyThatIsLetGo) {
  Swimmer swimmer(2, stillWater());
  const Immersed body = swimmer.add();
  body.readWrench(true);
  swimmer.scene.step(1e-4);
  const double added = 1000 * swimmer.shape->added_mass(5, 5), mass = swimmer.def.mass;
  const double expected = mass / 2 * kG * added / (mass + added);
  EXPECT_NEAR(body.wrench().added_mass.force.z() / expected, 1, byPrecision(1e-4, 1e-3));
}

// The reaction is that of Kirchhoff's equations, -d(A x)/dt and the Munk moment, with an error of
// second order.
TEST(WrenchReading, TheReactionIsKirchhoffs) {
  const auto errorAt = [](double step) {
    Swimmer swimmer(1.5, idealFluid(1000));
    swimmer.def.start.twist = {Vector3(1, 2, 3), Vector3(2, 0, 1)};
    swimmer.shape->faces = {};
    const Immersed body = swimmer.add();
    body.readWrench(true);
    const Vector6 added = 1000 * swimmer.shape->added_mass.diagonal();
    const auto momentum = [&] {
      const Matrix3 R =
          toQuaternion(swimmer.body->getWorldTransform().getRotation()).toRotationMatrix();
      const Vector3 l = added.head<3>().cwiseProduct(R.transpose() *
                                                     toVector3(swimmer.body->getAngularVelocity()));
      const Vector3 p = added.tail<3>().cwiseProduct(R.transpose() *
                                                     toVector3(swimmer.body->getLinearVelocity()));
      return Wrench{R * l, R * p};
    };
    const Wrench before = momentum();
    const Vector3 start = toVector3(swimmer.body->getWorldTransform().getOrigin());
    swimmer.scene.step(step);
    const Wrench after = momentum();
    const Vector3 way = toVector3(swimmer.body->getWorldTransform().getOrigin()) - start;
    Wrench expected = before;
    expected -= after;
    expected.torque -= way.cross(before.force + after.force) / 2;
    expected = 1 / step * expected;
    return (body.wrench().added_mass.vector() - expected.vector()).norm() /
           expected.vector().norm();
  };
  const double coarse = errorAt(0.005), fine = errorAt(0.0025);
  EXPECT_LT(coarse, byPrecision(1e-4, 1e-3));
  EXPECT_LT(fine, coarse / 3 + byPrecision(0, 1e-4));
}

TEST(WrenchReading, WindPushesAFloatingBody) {
  Swimmer swimmer(0.5);
  FluidRegion sea = waterBelow(0);
  sea.above = air();
  sea.above->velocity = {20, 0, 0};
  swimmer.scene.fluid.addRegion(sea);
  const Immersed body = swimmer.add();
  body.readWrench(true);
  swimmer.scene.step(1.0 / 120);
  EXPECT_GT(body.wrench().wind.force.x(), 0);
}

TEST(WrenchReading, AnAxisThatIsLockedIsHeldByConstraints) {
  Swimmer swimmer(2, stillWater());
  const Immersed body = swimmer.add();
  body.readWrench(true);
  swimmer.body->setLinearFactor({1, 1, 0});
  swimmer.scene.step(1.0 / 120, 2);
  const FluidWrench read = body.wrench();
  const double weight = swimmer.def.mass * kG;
  EXPECT_NEAR(read.buoyancy.force.z() / weight, 0.5, 1e-6);
  // Bullet takes the weight of a locked axis away when it is applied.
  EXPECT_NEAR((read.total() + read.constraints).force.z() / weight, 0, 1e-6);
}

// A step moves the same bits whether the wrench is read or not.
TEST(WrenchReading, ChangesNoMotion) {
  const auto run = [](bool is_read) {
    Swimmer swimmer(0.7);
    swimmer.scene.fluid.addRegion(waterBelow(0));
    btBoxShape shape(btVector3(bt(0.2), bt(0.2), bt(0.1)));
    btBoxShape ground(btVector3(9, 9, 1));
    swimmer.def.shape = &shape;
    swimmer.def.start.twist = {Vector3(1, 2, 3), Vector3(2, 0, 1)};
    swimmer.scene.add({0, Vector3::Ones(), startAt({0, 0, -1.15}), &ground});
    for (const double x : {0.0, 0.25}) {
      swimmer.def.start.position = {x, 0, x};
      swimmer.add().readWrench(is_read);
    }
    swimmer.scene.step(1.0 / 60, 60);
    return motionBytes(swimmer.scene.fluid);
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(WrenchReading, IsRefusedWhereNobodyHasAskedForIt) {
  Swimmer swimmer(1, stillWater());
  const Immersed body = swimmer.add();
  EXPECT_EQ(refusalOf<std::logic_error>([&] { body.wrench(); }),
            "wrench: it is not read; call readWrench(true) before a step");
  body.readWrench(true);
  EXPECT_GT(body.wrench().buoyancy.force.z(), 0);
  body.readWrench(false);
  EXPECT_THROW(body.wrench(), std::logic_error);
}

TEST(WrenchReading, StaysWhenAStateIsRestored) {
  Swimmer swimmer(2, stillWater());
  const Immersed body = swimmer.add();
  body.readWrench(true);
  const WorldState state = swimmer.scene.fluid.save();
  swimmer.scene.fluid.restore(state);
  swimmer.scene.step(1.0 / 120);
  EXPECT_GT(body.wrench().buoyancy.force.z(), 0);
}

// Checks the wet part of a body against elementary geometry.

constexpr double kGeometryRounding = byPrecision(1e-12, 1e-6);

struct Sea {
  Sea() {
    scene.world.setGravity({0, 0, bt(-9.81)});
    id = scene.fluid.addRegion(waterBelow(1));
  }
  WetState wetAt(const FluidBody& shape, const Vector3& position,
                 const Quaternion& orientation = Quaternion::Identity()) {
    const BodyDef def{1, Vector3::Ones(), startAt(position, {}, orientation)};
    return scene.fluid.add(scene.add(def), {std::make_shared<FluidBody>(shape)}).wet();
  }
  FluidWorld scene;
  RegionId id;
};

TEST(WetState, OfABoxIsThatOfItsDraught) {
  Sea sea;
  const WetState wet = sea.wetAt(floatingBox(kBoxSize), {3, 4, 1.1});
  EXPECT_NEAR(wet.draught, 0.1, kGeometryRounding);
  EXPECT_NEAR(wet.volume, 0.8 * 0.6 * 0.1, kGeometryRounding);
  EXPECT_NEAR(wet.share, 0.25, kGeometryRounding);
  EXPECT_NEAR(wet.area, 0.8 * 0.6 + 2 * 0.1 * (0.8 + 0.6), kGeometryRounding);
  EXPECT_NEAR((wet.centre_of_buoyancy - Vector3(3, 4, 0.95)).norm(), 0, 4 * kGeometryRounding);
  EXPECT_EQ(wet.region, sea.id);
}

TEST(WetState, OfATurnedBoxIsThatOfTheWedgeInTheWater) {
  Sea sea;
  const Quaternion edge_down(Eigen::AngleAxisd(kPi / 4, Vector3::UnitX()));
  const double depth = 0.2;  // of the edge
  const double lowest = (0.6 + 0.4) / 2 / std::sqrt(2.0);
  const WetState wet = sea.wetAt(floatingBox(kBoxSize), {0, 0, 1 + lowest - depth}, edge_down);
  EXPECT_NEAR(wet.draught, depth, 4 * kGeometryRounding);
  EXPECT_NEAR(wet.volume, 0.8 * depth * depth, kGeometryRounding);
  EXPECT_NEAR(wet.area, 2 * 0.8 * std::sqrt(2.0) * depth + 2 * depth * depth,
              4 * kGeometryRounding);
  const Vector3 centre(0, (0.4 - 0.6) / 2 / std::sqrt(2.0), 1 - depth / 3);
  EXPECT_LT((wet.centre_of_buoyancy - centre).norm(), 4 * kGeometryRounding);
}

TEST(WetState, OfABodyFarAboveOrBelowIsNothingOrAll) {
  Sea sea;
  const FluidBody shape = floatingBox(kBoxSize);
  const WetState above = sea.wetAt(shape, {0, 0, 9}), below = sea.wetAt(shape, {0, 0, -9});
  EXPECT_EQ(above.share, 0);
  EXPECT_EQ(above.volume, 0);
  EXPECT_EQ(above.area, 0);
  EXPECT_EQ(above.draught, 0);
  EXPECT_NEAR(below.share, 1, kGeometryRounding);
  EXPECT_NEAR(below.area, shape.area, kGeometryRounding);
  EXPECT_NEAR(below.draught, 10.2, 10 * kGeometryRounding);
}

TEST(WetState, WithoutASurfaceIsAllOfTheBody) {
  FluidWorld scene;
  AttachDef attach{std::make_shared<FluidBody>(floatingBox(kBoxSize)), water()};
  const WetState wet = scene.fluid.add(scene.add(BodyDef{}), attach).wet();
  EXPECT_EQ(wet.share, 1);
  EXPECT_TRUE(std::isinf(wet.draught));
  EXPECT_EQ(wet.region, RegionId::kNone);
}

// The air beside the water is that above it.
TEST(WetState, OnLandIsNothing) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  FluidRegion lake = waterBelow(0);
  lake.bounds = RegionBounds{{-5, -5, -5}, {5, 5, 5}};
  scene.fluid.addRegion(lake);
  AttachDef attach{std::make_shared<FluidBody>(floatingBox(kBoxSize)), air()};
  const BodyDef on_land{1, Vector3::Ones(), startAt({20, 0, 0})};
  EXPECT_EQ(scene.fluid.add(scene.add(on_land), attach).wet().volume, 0);
  EXPECT_EQ(scene.fluid.add(scene.add(BodyDef{}), attach).wet().draught, 0.2);
}

TEST(WetState, FollowsTheWavesAfterAStep) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  FluidRegion region = waterBelow(0);
  const auto waves =
      std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{{0.1, 3, {1, 0, 0}, 0}});
  region.surface = waves;
  scene.fluid.addRegion(region);
  AttachDef attach{std::make_shared<FluidBody>(floatingBall(0.1))};
  btRigidBody& body = scene.add(BodyDef{2, Vector3::Constant(0.01)});
  const Immersed ball = scene.fluid.add(body, attach);
  scene.step(1.0 / 60, 20);
  const Vector3 at = toVector3(body.getWorldTransform().getOrigin());
  const double height = waves->sample(at, scene.fluid.time()).height;
  EXPECT_GT(std::abs(waves->sample(at, 0).height - height), 0.01);
  EXPECT_NEAR(ball.wet().draught, height + 0.1, 1e-3);
}

class WetLink : public Robots {};

TEST_F(WetLink, IsWhereItsJointsHaveBroughtIt) {
  world.world.setGravity({0, 0, bt(-9.81)});
  world.fluid.addRegion(waterBelow(0));
  btMultiBody& body = add();
  const Immersed link = world.fluid.add(body, 1, {std::make_shared<FluidBody>(floatingBall(0.1))});
  body.setBasePos({0, 0, -5});
  RobotWorld::moveColliders(body);
  const WetState wet = link.wet();
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> places;
  body.forwardKinematics(turns, places);
  const Vector3 at = toVector3(body.getLink(1).m_cachedWorldTransform.getOrigin());
  EXPECT_EQ(wet.share, 1);
  EXPECT_NEAR((wet.centre_of_buoyancy - at).norm(), 0, byPrecision(1e-12, 1e-5));
}

}  // namespace
}  // namespace ambient::test
