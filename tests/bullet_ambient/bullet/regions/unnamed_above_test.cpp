#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/support/bodies/part_bodies.h"

// Surfaces of which nothing is said but the water.
namespace ambient::test {
namespace {

FluidRegion bareSea(const Vector3& up) {
  FluidRegion sea;
  sea.below = water();
  sea.surface = std::make_shared<StillWater>(0, up);
  return sea;
}

/// Falls from 30 m in a world whose gravity is along -z.
struct FallingBall {
  explicit FallingBall(const Medium& own) {
    world.fluid.setReport([this](const std::string& text) { said.push_back(text); });
    world.world.setGravity({0, 0, bt(-9.81)});
    BodyDef def{20, Vector3::Constant(0.3), {}, nullptr};
    def.start.position = {0, 0, 30};
    body = &world.add(def, floatingEllipsoid(Vector3(0.2, 0.2, 0.2), 2), own);
  }
  double height() const { return static_cast<double>(body->getWorldTransform().getOrigin().z()); }

  FluidWorld world;
  std::vector<std::string> said;
  btRigidBody* body = nullptr;
};

TEST(UnnamedAbove, ABodyAboveTheSeaFallsAsInItsOwnMedium) {
  for (const Medium& own : {air(), Medium{}, water()}) {
    FallingBall in_air(air()), over_sea(own), over_vacuum(own);
    over_sea.world.fluid.addRegion(bareSea({0, 0, 1}));
    FluidRegion below_vacuum = bareSea({0, 0, 1});
    below_vacuum.above = Medium{};
    over_vacuum.world.fluid.addRegion(below_vacuum);
    for (FallingBall* ball : {&in_air, &over_sea, &over_vacuum}) ball->world.step(kWorldStep, 200);
    EXPECT_EQ(over_sea.world.of(*over_sea.body).medium().density, air().density);
    EXPECT_EQ(over_sea.height(), in_air.height());
    EXPECT_LT(over_vacuum.height(), in_air.height() - 0.01) << "the drag of air is seen";
  }
}

TEST(UnnamedAbove, RegionsComeAndGo) {
  FallingBall ball(Medium{});
  const auto density = [&] {
    ball.world.step(kWorldStep);
    return ball.world.of(*ball.body).medium().density;
  };
  const RegionId sea = ball.world.fluid.addRegion(bareSea({0, 0, 1}));
  EXPECT_EQ(density(), air().density);
  ball.world.of(*ball.body).setMedium(idealFluid(0.5));
  EXPECT_EQ(density(), 0.5);
  ball.world.fluid.removeRegion(sea);
  ball.world.of(*ball.body).setMedium(Medium{});
  EXPECT_EQ(density(), 0);
  ball.world.fluid.addRegion(bareSea({0, 0, 1}));
  EXPECT_EQ(density(), air().density);
}

TEST(DirectionUp, ThatIsNotAgainstGravityIsSaidOnce) {
  for (const Vector3& up : {Vector3(0, 0, -1), Vector3(0, 1, 0), Vector3(0, 1, 0.9)}) {
    FallingBall ball(air());
    ball.world.fluid.addRegion(bareSea(up));
    ball.world.step(kWorldStep, 3);
    ASSERT_EQ(ball.said.size(), 1U) << up.transpose();
    EXPECT_NE(ball.said[0].find("region of fluid 0"), std::string::npos) << ball.said[0];
    EXPECT_NE(ball.said[0].find("gravity is (0, 0, -9.81) m/s^2"), std::string::npos)
        << ball.said[0];
  }
  for (const Vector3& up : {Vector3(0, 0, 2), Vector3(0, 0.9, 1)}) {
    FallingBall ball(air());
    ball.world.fluid.addRegion(bareSea(up));
    ball.world.step(kWorldStep, 3);
    EXPECT_TRUE(ball.said.empty()) << up.transpose() << ": " << ball.said.front();
  }
}

}  // namespace
}  // namespace ambient::test
