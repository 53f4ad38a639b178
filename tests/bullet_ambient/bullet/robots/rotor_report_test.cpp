#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

// Joints that turn a link by half a turn or more in a step are told.
namespace ambient::test {
namespace {

constexpr double kRotorStep = 1.0 / 60;

/// Rotors on hinges, in a fluid that hardly slows them down.
struct Rotors : RobotWorld {
  Rotors() {
    fluid.setReport([this](const std::string& sentence) { said.push_back(sentence); });
  }

  /// `turns`: per step.
  void add(const std::string& name, double turns, const Medium& medium = idealFluid(1e-9),
           bool is_prismatic = false) {
    const Vector3 axes(0.5, 0.05, 0.02);
    auto robot = std::make_unique<btMultiBody>(1, 0, btVector3(0, 0, 0), true, false);
    const btVector3 moments = toBullet(ellipsoidMoments(axes, 1)), none(0, 0, 0);
    const btQuaternion straight = btQuaternion::getIdentity();
    if (is_prismatic) {
      robot->setupPrismatic(0, 1, moments, -1, straight, {0, 0, 1}, none, none, true);
    } else {
      robot->setupRevolute(0, 1, moments, -1, straight, {0, 0, 1}, none, none, true);
    }
    robot->finalizeMultiDof();
    robot->setMaxCoordinateVelocity(1000);
    btMultiBody& tree = take(std::move(robot), 0);
    tree.setCanSleep(false);
    tree.setLinearDamping(0);
    tree.setAngularDamping(0);
    tree.setJointVel(0, bt(2 * kPi * turns / kRotorStep));
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(axes, 1));
    def.medium = medium;
    def.name = name;
    fluid.add(tree, 0, def);
  }

  std::vector<std::string> said;
};

TEST(RotorReport, ARotorIsToldOnceWithItsNameAndTheLimit) {
  Rotors rotors;
  rotors.add("rotor", 0.51);
  rotors.step(kRotorStep, 100);
  ASSERT_EQ(rotors.said.size(), 1u);
  const std::string& sentence = rotors.said[0];
  for (const char* part : {"'rotor'", "0.51 turns", "half a turn", "take shorter steps"})
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
  EXPECT_EQ(rotors.fluid.counters().too_long, 1);
}

TEST(RotorReport, OneOfManyRotorsIsToldAndAllAreCounted) {
  Rotors rotors;
  rotors.add("first", 1);
  rotors.add("second", -0.7);
  rotors.add("slow", 0.3);
  rotors.step(kRotorStep, 20);
  EXPECT_EQ(rotors.said.size(), 1u);
  EXPECT_EQ(rotors.fluid.counters().too_long, 2);
}

TEST(RotorReport, NothingIsToldBelowHalfATurnInAVacuumAndOfSlides) {
  Rotors rotors;
  rotors.add("rotor", 0.49);
  rotors.add("backwards", -0.49);
  rotors.add("in a vacuum", 1, Medium{});
  rotors.add("slide", 1, idealFluid(1e-9), true);
  rotors.step(kRotorStep, 20);
  EXPECT_TRUE(rotors.said.empty()) << rotors.said.front();
  EXPECT_EQ(rotors.fluid.counters().too_long, 0);
}

}  // namespace
}  // namespace ambient::test
