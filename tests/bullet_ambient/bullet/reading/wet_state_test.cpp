#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/part_bodies.h"

// Checks the wet part of a body against elementary geometry.
namespace ambient::test {
namespace {

constexpr double kGeometryRounding = byPrecision(1e-12, 1e-6);

struct Sea {
  Sea() {
    scene.world.setGravity({0, 0, bt(-9.81)});
    id = scene.fluid.addRegion(waterBelow(1));
  }
  WetState wetAt(const FluidBody& shape, const Vector3& position,
                 const Quaternion& orientation = Quaternion::Identity()) {
    BodyDef def;
    def.start.position = position;
    def.start.orientation = orientation;
    AttachDef attach;
    attach.fluid_body = std::make_shared<FluidBody>(shape);
    return scene.fluid.add(scene.add(def), attach).wet();
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

TEST(WetState, OfATurnedBoxIsASumOverCutTriangles) {
  Sea sea;
  const Quaternion edge_down(Eigen::AngleAxisd(kPi / 4, Vector3::UnitX()));
  const double depth = 0.2;  // of the edge
  const double lowest = (0.6 + 0.4) / 2 / std::sqrt(2.0);
  const WetState wet = sea.wetAt(floatingBox(kBoxSize), {0, 0, 1 + lowest - depth}, edge_down);
  EXPECT_NEAR(wet.draught, depth, 4 * kGeometryRounding);
  EXPECT_NEAR(wet.volume, 0.8 * depth * depth, kGeometryRounding);
  EXPECT_NEAR(wet.area, 2 * 0.8 * std::sqrt(2.0) * depth + 2 * depth * depth,
              4 * kGeometryRounding);
}

TEST(WetState, OfABallIsACap) {
  Sea sea;
  const WetState wet = sea.wetAt(floatingBall(0.5), {0, 0, 1.3});
  EXPECT_NEAR(wet.draught, 0.2, kGeometryRounding);
  EXPECT_NEAR(wet.area / (2 * kPi * 0.5 * 0.2), 1, 0.05);  // its area is that of its triangles
  EXPECT_NEAR(wet.volume, kPi * 0.04 * (1.5 - 0.2) / 3, kGeometryRounding);
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
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(floatingBox(kBoxSize));
  attach.medium = water();
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
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(floatingBox(kBoxSize));
  attach.medium = air();
  BodyDef on_land;
  on_land.start.position = {20, 0, 0};
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
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(floatingBall(0.1));
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
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(floatingBall(0.1));
  const Immersed link = world.fluid.add(body, 1, def);
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
