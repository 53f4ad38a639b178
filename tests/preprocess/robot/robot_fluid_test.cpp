#include "preprocess/robot/robot_fluid.h"

#include <gtest/gtest.h>

#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/preprocess/robot/fluid_robot_world.h"
#include "tests/preprocess/robot/urdf_text_of.h"
#include "tests/reference/ellipsoid_added_mass.h"

namespace ambient {
namespace {

std::string ellipsoidLink(const std::string& name, const std::string& more = "") {
  return massiveLink(name, more + R"(<collision><origin xyz="0 0 0.5"/>
      <geometry><ellipsoid semi_axes="0.1 0.2 0.3"/></geometry></collision>)");
}

TEST(RobotFluid, LinksGetTheAddedMassOfTheirShapes) {
  const RobotModel model = parseRobot(
      ellipsoidLink("a") + ellipsoidLink("b") + ellipsoidLink("c", "<ambient medium=\"none\"/>") +
      massiveLink("d") + joint("ab", "continuous", "a", "b", R"(<axis xyz="1 0 0"/>)") +
      joint("ac", "continuous", "a", "c") + joint("ad", "continuous", "a", "d"));
  FluidRobotWorld in;
  Robot robot(model);
  robot.addTo(in.world);
  FluidBodyCache shapes;
  AttachDef def;
  def.medium = water();
  EXPECT_EQ(attachRobot(in.fluid, robot, shapes, def), (std::vector<std::string>{"a", "b"}));
  const Matrix6 K = in.fluid.find(robot.multiBody(), robot.linkNumber("b"))->inertia();
  const auto added = reference::ellipsoidAddedMass({0.1, 0.2, 0.3});
  // Principal axes of the mass are the link's, in equal order. Linear parts are independent of the
  // origin.
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(K(3 + k, 3 + k), 2 + water().density * added[3 + k], 1e-4) << k;
  in.world.stepSimulation(btScalar(0.01), 0);
  in.fluid.clear();
}

TEST(RobotFluid, RefusalNamesTheLinkAndLeavesNothing) {
  const RobotModel model = parseRobot(
      ellipsoidLink("a") + ellipsoidLink("b", "<ambient fluid_body=\"no/such.ambient\"/>") +
      joint("ab", "continuous", "a", "b"));
  FluidRobotWorld in;
  Robot robot(model);
  robot.addTo(in.world);
  FluidBodyCache shapes;
  AttachDef def;
  def.medium = water();
  try {
    attachRobot(in.fluid, robot, shapes, def);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("r.urdf: link \"b\": no/such.ambient"), 0u)
        << error.what();
  }
  EXPECT_FALSE(in.fluid.find(robot.multiBody(), -1));
}

}  // namespace
}  // namespace ambient
