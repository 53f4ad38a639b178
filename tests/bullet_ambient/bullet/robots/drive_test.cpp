#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/reading.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
namespace {

// Tethers as docs/thrusters.md describes them.

constexpr double kStep = 1.0 / 60;
const Vector3 kVehicleAxes(0.2, 0.17, 0.0774);

/// A vehicle on a tether of 10 m: links as dense as the water, the vehicle the last of them, in one
/// btMultiBody with a fixed base, where it hangs straight down in a current.
class TetheredVehicle {
 public:
  /// `weight`: of the vehicle in the water [kg].
  TetheredVehicle(double current, double weight) {
    in_.world.getSolverInfo() = btContactSolverInfo();
    in_.world.setGravity({0, 0, bt(-9.81)});
    const Vector3 axes(0.005, 0.005, kHalf);
    const auto link = std::make_shared<FluidBody>(meshedEllipsoid(axes, 1));
    const auto vehicle = std::make_shared<FluidBody>(meshedEllipsoid(kVehicleAxes, 2));
    for (int i = 0; i < kLinks; ++i) setUp(i, axes, kDensity * link->volume);
    setUp(kLinks, kVehicleAxes, 11 + weight);
    body_.finalizeMultiDof();
    body_.setLinearDamping(0);
    body_.setAngularDamping(0);
    in_.world.addMultiBody(&body_);
    const Medium medium{kDensity, 0.001, {current, 0, 0}, {0, 0, 0}};
    for (int i = 0; i <= kLinks; ++i)
      in_.fluid.add(body_, i, {i < kLinks ? link : vehicle, medium});
  }
  ~TetheredVehicle() { in_.world.removeMultiBody(&body_); }

  void step(double step) { in_.step(step); }
  Vector3 place() { return toVector3(body_.localPosToWorld(kLinks, {0, 0, 0})); }
  /// Distance of the vehicle's eye from the end of the tether [m].
  double gap() {
    const btVector3 eye = body_.localPosToWorld(kLinks, {0, 0, bt(kVehicleAxes.z())});
    return static_cast<double>(
        (eye - body_.localPosToWorld(kLinks - 1, {0, 0, bt(-kHalf)})).length());
  }

 private:
  static constexpr int kLinks = 20;
  static constexpr double kHalf = 0.25, kDensity = 1000;

  void setUp(int link, const Vector3& axes, double mass) {
    const btVector3 below(0, 0, link == 0 ? 0 : bt(-kHalf)), above(0, 0, bt(-axes.z()));
    body_.setupSpherical(link, bt(mass), toBullet(ellipsoidMoments(axes, mass)), link - 1,
                         btQuaternion::getIdentity(), below, above, true);
  }

  RobotWorld in_;
  btMultiBody body_{kLinks + 1, 0, {0, 0, 0}, true, false};
};

/// The largest gap [m] and speed [m/s] of the vehicle within 20 s, and its place at the end [m].
struct TetherRun {
  double gap = 0, speed = 0;
  Vector3 place{0, 0, 0};
};

TetherRun hang(double current, double weight, double step) {
  TetheredVehicle in(current, weight);
  TetherRun run;
  run.place = in.place();
  for (int i = 0; i < 20 / step; ++i) {
    in.step(step);
    run.gap = std::max(run.gap, in.gap());
    run.speed = std::max(run.speed, (in.place() - run.place).norm() / step);
    run.place = in.place();
  }
  return run;
}

TEST(Drive, ATetherOfLinksHoldsAVehicle) {
  for (const auto& [current, weight] : {std::pair(1.5, 0.0), {0.5, 90.0}}) {
    const TetherRun run = hang(current, weight, kStep), fine = hang(current, weight, kStep / 4);
    EXPECT_LT(run.gap, byPrecision(1e-13, 1e-4));
    EXPECT_LT(run.speed, 1.3 * current);  // the current takes it along, the tether swings it round
    EXPECT_LT((run.place - fine.place).norm(), 0.03) << current << " m/s, " << weight << " kg";
  }
}

// Joints that turn a link by half a turn or more in a step are told.

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
    btMultiBody& tree = takeUndamped(std::move(robot));
    tree.setJointVel(0, bt(2 * kPi * turns / kRotorStep));
    AttachDef def{std::make_shared<FluidBody>(meshedEllipsoid(axes, 1)), medium};
    def.name = name;
    fluid.add(tree, 0, def);
  }

  std::vector<std::string> said;
};

TEST(RotorReport, OneOfManyRotorsIsToldOnceWithItsNameAndTheLimitAndAllAreCounted) {
  Rotors rotors;
  rotors.add("rotor", 0.51);
  rotors.add("second", -0.7);
  rotors.add("slow", 0.3);
  rotors.step(kRotorStep, 100);
  ASSERT_EQ(rotors.said.size(), 1u);
  const std::string& sentence = rotors.said[0];
  for (const char* part : {"'rotor'", "0.51 turns", "half a turn", "take shorter steps"})
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
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

// Wrenches that are read of links.

constexpr double kLinkStep = 1.0 / 240;

class LinkReading : public Robots {
 protected:
  void readAll(const btMultiBody& body) {
    for (int link = -1; link < body.getNumLinks(); ++link)
      world.fluid.find(body, link)->readWrench(true);
  }
  // Forces on all links, and the largest of them.
  struct Sum {
    Vector3 force = Vector3::Zero();
    double largest = 0;
  };
  Sum constraintsOf(const btMultiBody& body) {
    Sum sum;
    for (int link = -1; link < body.getNumLinks(); ++link) {
      const Vector3 force = world.fluid.find(body, link)->wrench().constraints.force;
      sum.force += force;
      sum.largest = std::max(sum.largest, force.norm());
    }
    return sum;
  }
};

// Joint forces cancel over a tree that nothing else holds: the fluid has all the rest of
// the change of the momentum.
TEST_F(LinkReading, ForcesInJointsCancelOverAFreeTree) {
  world.world.setGravity({0, 0, bt(-9.81)});
  for (int i = 0; i < 100; ++i) {
    btMultiBody& body = add({1 + i % 5, i % 2 ? Joints::kSmooth : Joints::kRevolute});
    putIntoFluid(arbitrary, world, body, 2);
    readAll(body);
    world.step(kLinkStep, 1 + i % 3);
    const Sum sum = constraintsOf(body);
    EXPECT_GT(sum.largest, 0) << i;
    EXPECT_LT(sum.force.norm(), byPrecision(1e-9, 2e-3) * sum.largest) << i;
    world.remove(body);
  }
}

}  // namespace
}  // namespace ambient::test
